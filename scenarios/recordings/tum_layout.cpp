#include "scenarios/recordings/tum_layout.h"

#include <charconv>
#include <cmath>
#include <sstream>
#include <string>

#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {
namespace {

constexpr double kMaxStamp_s = 1e12;  // some 30000 years; differences of stamps are then exact to 0.1 ms

// Returns seconds since an arbitrary origin. Throws InputError about `where`, the list with ":line", unless
// the whole text is a finite number of at most kMaxStamp_s.
double read_stamp(const std::string& where, const std::string& stamp) {
  double stamp_s = 0;
  const auto [end, error] = std::from_chars(stamp.data(), stamp.data() + stamp.size(), stamp_s);
  if (error == std::errc() && end == stamp.data() + stamp.size() && std::abs(stamp_s) <= kMaxStamp_s)
    return stamp_s;
  refuse(where, "timestamp '", stamp.substr(0, 32), "': expected a number of seconds");
}

}  // namespace

std::vector<StampedFile> read_stamped_list(const std::filesystem::path& list) {
  const std::string text = read_input_text(list, "expected lines 'timestamp filename'");
  std::istringstream stream{std::string(without_byte_order_mark(text))};
  stream.exceptions(std::ios::badbit);  // throws if memory runs out, which would otherwise pass for the end
  std::vector<StampedFile> files;
  std::string line;
  // Files from other systems may end their lines with CR LF; blank lines and comments are skipped.
  for (int line_number = 1; std::getline(stream, line); ++line_number) {
    if (line.ends_with('\r')) line.pop_back();
    std::istringstream words(line);
    words.exceptions(std::ios::badbit);
    std::string stamp, name, surplus;
    if (!(words >> stamp) || stamp.front() == '#') continue;
    const std::string where = list.string() + ":" + std::to_string(line_number);
    const double stamp_s = read_stamp(where, stamp);
    if (!(words >> name) || words >> surplus)
      refuse(where, "'", line.substr(0, 64), "': expected one timestamp and one file name");
    if (!files.empty() && stamp_s <= files.back().stamp_s)
      refuse(where, "timestamp ", stamp, ": expected above that of the line before");
    files.push_back({stamp_s, list.parent_path() / name});
    const std::filesystem::path& file = files.back().file;
    if (!std::filesystem::is_regular_file(file)) refuse(where, "no file ", file.string());
  }
  if (files.empty()) refuse(list.string(), "lists no file: expected lines 'timestamp filename'");
  return files;
}

std::vector<RecordedFrame> associate_stamps(const std::vector<StampedFile>& depth,
                                            const std::vector<StampedFile>& colour) {
  constexpr double kMaxApart_s = 0.02;  // the tolerance of the benchmark's own association
  std::vector<RecordedFrame> frames;
  auto first = colour.begin();
  for (const StampedFile& image : depth) {
    RecordedFrame frame{image.stamp_s - depth.front().stamp_s, image.file, {}};
    double nearest_s = kMaxApart_s;
    // The stamps increase, so a colour image that is too early for this depth image is too early for all
    // later ones.
    while (first != colour.end() && image.stamp_s - first->stamp_s > kMaxApart_s) ++first;
    for (auto other = first; other != colour.end() && other->stamp_s - image.stamp_s <= kMaxApart_s;
         ++other) {
      const double off_s = std::abs(other->stamp_s - image.stamp_s);
      if (off_s <= nearest_s) nearest_s = off_s, frame.colour = other->file;
    }
    frames.push_back(frame);
  }
  return frames;
}

}  // namespace remote_touch
