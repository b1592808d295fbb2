// The runs of several parts of a sweep, on the disk, in the order of their numbers.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// Holds the runs of parts that together may be larger than the memory. add() copies each part to a temporary
// file, which has no name and so vanishes with the program. After complete(), values() returns blocks over
// all runs. The memory grows with the number of parts and of failed runs, and without `is_whole` with that of
// all runs.
class RunSpool {
 public:
  // Blocks of this many places, from multiples of it on, are read fastest.
  static constexpr std::size_t kWindow = 1 << 17;
  // Returns the values at `count` places from `first` on of an array of a part: a measure, state, notes,
  // error or run.
  using PartValues = std::function<Values(const std::string& array, std::size_t first, std::size_t count)>;

  // outline: the sweep, with measures but without values. is_refined: runs that no part holds are not
  // sampled. beside: a file in whose folder the temporary file lies. Throws InputError, which names `beside`,
  // if it cannot be written.
  RunSpool(const SweepResult& outline, bool is_refined, const std::filesystem::path& beside);
  ~RunSpool();
  RunSpool(const RunSpool&) = delete;
  RunSpool& operator=(const RunSpool&) = delete;

  // name: of the part, for errors. Throws InputError if its runs are not increasing numbers of the sweep's
  // runs.
  void add(const std::string& name, std::size_t held, const PartValues& values);
  // Call once, after the last part. is_whole: the places are the runs of the whole sweep, else the runs of
  // the parts. Throws InputError if two parts hold the same run, and, for a whole sweep without refinement,
  // if a run is missing.
  void complete(bool is_whole);

  // The sweep without values, after complete() with the runs that the places have.
  const SweepResult& outline() const { return outline_; }
  bool is_refined() const { return is_refined_; }
  std::size_t longest_error() const;  // bytes, at least 1
  // The values of an array at places that complete() defined. With refinement there is also the array round.
  Values values(const std::string& array, std::size_t first, std::size_t count);

 private:
  struct Part {
    std::string name;
    std::size_t held;
    std::uint64_t offset;  // bytes before its arrays in the temporary file; one array follows the other
  };
  using Words = std::vector<std::uint64_t>;  // the bits of values of any type
  std::size_t array_number(const std::string& array) const;
  std::size_t place_of(std::uint64_t run) const;
  void put(const Words& words);
  Words get(const Part& part, std::size_t array, std::size_t first, std::size_t count) const;
  void copy_errors(const Part& part, const PartValues& values);
  void find_held();
  void find_starts(std::size_t part);
  void load(std::size_t array, std::size_t window);
  void scatter(std::size_t array, std::size_t part);
  void require_each_run_once(std::size_t window);
  std::vector<std::string> errors(std::size_t first, std::size_t count) const;
  std::uint64_t word(std::size_t array, std::size_t place);

  SweepResult outline_;
  const bool is_refined_;
  const std::filesystem::path beside_;
  std::vector<std::string> arrays_;  // the names of those in the temporary file; the first is run
  int file_ = -1;
  std::uint64_t size_ = 0;
  std::vector<Part> parts_;
  std::map<std::uint64_t, std::string> errors_;  // errors of the failed runs
  std::vector<Words> starts_;  // each part has the first of its places in each window, and their number
  std::size_t loaded_array_ = 0, loaded_window_ = 0;
  bool is_loaded_ = false;
  Words loaded_;
};

}  // namespace remote_touch
