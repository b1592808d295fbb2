// The frames of a scenario that were used last.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "core/search/neighbour_search.h"

namespace remote_touch {

// Hand, renderer and truth use the same frames in turn, and making a frame may take far longer than copying
// it. Several threads may call get() at the same time.
class KeptFrames {
 public:
  using Points = std::shared_ptr<const NeighbourSearch>;

  // Pre: at_most is 1 or more.
  explicit KeptFrames(std::size_t at_most) : at_most_(at_most) {}

  // Returns the frame if it is kept. Otherwise makes it, and keeps it instead of the frame that was used
  // longest ago. What make() throws is passed on, and nothing is kept. Threads that ask for the same frame
  // at the same time may each make it.
  Points get(std::size_t frame, const std::function<Points()>& make);

 private:
  struct Kept {
    std::size_t frame;
    Points points;
  };
  Points find(std::size_t frame);

  const std::size_t at_most_;
  std::mutex mutex_;        // guards kept_
  std::vector<Kept> kept_;  // the frame that was used last is in front
};

}  // namespace remote_touch
