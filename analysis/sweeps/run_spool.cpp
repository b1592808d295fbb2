#include "analysis/sweeps/sweep_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <limits>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

constexpr std::size_t kWindow = RunSpool::kWindow;  // places that are loaded together
constexpr std::size_t kBlock = 1 << 16;             // values that are copied together
constexpr std::uint64_t kUnset = ~std::uint64_t{0};

// Opens a file without a name in the folder of that file. Returns -1 with errno set on failure.
int open_nameless(const std::filesystem::path& beside) {
  const std::filesystem::path parent = resolved(beside).parent_path(), folder = parent.empty() ? "." : parent;
  const int nameless = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (nameless >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL)) return nameless;
  // Some file systems, such as NFS, have no files without a name.
  std::string name = (folder / ".remote-touch-merge-XXXXXX").string();
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file >= 0) ::unlink(name.c_str());
  return file;
}

std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}
std::uint64_t bits(std::int32_t value) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
}
std::uint64_t bits(std::uint64_t value) {
  return value;
}
std::uint64_t bits(const std::string&) {
  return 0;
}

std::vector<std::uint64_t> words_of(const Values& values) {
  std::vector<std::uint64_t> words;
  const auto add = [&](const auto& all) {
    for (const auto& value : all) words.push_back(bits(value));
  };
  std::visit(add, values);
  return words;
}

}  // namespace

RunSpool::RunSpool(const SweepResult& outline, bool is_refined, const std::filesystem::path& beside)
    : outline_(outline), is_refined_(is_refined), beside_(beside), arrays_{"run"} {
  for (const Column& measure : outline.measures) arrays_.push_back(measure.name);
  arrays_.emplace_back("state");
  if (!outline.note_kinds.empty()) arrays_.emplace_back("notes");
  if (is_refined) arrays_.emplace_back("round");
  file_ = open_nameless(beside);
  if (file_ < 0) refuse_writing(beside, errno, "a file in a writable folder");
}

RunSpool::~RunSpool() {
  if (file_ >= 0) ::close(file_);
}

std::size_t RunSpool::array_number(const std::string& array) const {
  return static_cast<std::size_t>(std::ranges::find(arrays_, array) - arrays_.begin());
}

void RunSpool::put(const Words& words) {
  std::size_t done = 0;
  const int error = write_all(file_, words.data(), words.size() * sizeof words[0], done);
  size_ += done;
  if (error != 0)
    refuse_writing(beside_, error,
                   "a folder with free space for the runs of all parts, " +
                       std::to_string(arrays_.size() * sizeof words[0]) +
                       " bytes each, beside the file; nothing was changed");
}

RunSpool::Words RunSpool::get(const Part& part, std::size_t array, std::size_t first,
                              std::size_t count) const {
  Words words(count);
  const std::uint64_t at = part.offset + (array * part.held + first) * sizeof words[0];
  const auto size = static_cast<ssize_t>(count * sizeof words[0]);
  if (read_all(file_, words.data(), static_cast<std::size_t>(size), static_cast<off_t>(at)) != size)
    refuse_reading(beside_, errno);
  return words;
}

void RunSpool::add(const std::string& name, std::size_t held, const PartValues& values) {
  const Part part{name, held, size_};
  std::uint64_t least = 0;  // least number that the next run may have
  for (const std::string& array : arrays_)
    for (std::size_t first = 0; first < held; first += kBlock) {
      const Words words = words_of(values(array, first, std::min(kBlock, held - first)));
      if (&array == &arrays_.front())
        for (const std::uint64_t run : words) {
          if (run < least || run >= outline_.run_count())
            throw InputError(name, "damaged (its runs are not increasing numbers of the sweep's runs)");
          least = run + 1;
        }
      put(words);
    }
  copy_errors(part, values);
  parts_.push_back(part);
}

// Copies the errors of the failed runs, of which there are few.
void RunSpool::copy_errors(const Part& part, const PartValues& values) {
  const std::size_t state = array_number("state");
  for (std::size_t first = 0; first < part.held; first += kBlock) {
    const std::size_t count = std::min(kBlock, part.held - first);
    const Words states = get(part, state, first, count);
    if (std::ranges::find(states, bits(static_cast<std::int32_t>(RunState::failed))) == states.end())
      continue;
    const Words runs = get(part, 0, first, count);
    const auto errors = std::get<std::vector<std::string>>(values("error", first, count));
    for (std::size_t i = 0; i < count; ++i)
      if (!errors[i].empty()) errors_[runs[i]] = errors[i];
  }
}

std::size_t RunSpool::longest_error() const {
  std::size_t longest = 1;
  for (const auto& [run, error] : errors_) longest = std::max(longest, error.size());
  return longest;
}

void RunSpool::find_held() {
  std::vector<std::uint64_t>& held = outline_.part.emplace();
  std::size_t all = 0;
  for (const Part& part : parts_) all += part.held;
  held.reserve(all);
  for (const Part& part : parts_)
    for (std::size_t first = 0; first < part.held; first += kBlock) {
      const Words runs = get(part, 0, first, std::min(kBlock, part.held - first));
      held.insert(held.end(), runs.begin(), runs.end());
    }
  std::ranges::sort(held);
  held.erase(std::unique(held.begin(), held.end()), held.end());  // load() finds runs that were there twice
}

// pre: a part holds the run.
std::size_t RunSpool::place_of(std::uint64_t run) const {
  return outline_.place_of(static_cast<std::size_t>(run)).value();
}

void RunSpool::find_starts(std::size_t number) {
  const Part& part = parts_[number];
  Words& starts = starts_[number];
  for (std::size_t first = 0; first < part.held; first += kBlock) {
    const Words runs = get(part, 0, first, std::min(kBlock, part.held - first));
    for (std::size_t i = 0; i < runs.size(); ++i)
      while (starts.size() <= place_of(runs[i]) / kWindow) starts.push_back(first + i);
  }
  starts.resize(outline_.held_count() / kWindow + 2, part.held);
}

void RunSpool::complete(bool is_whole) {
  if (!is_whole) find_held();
  starts_.resize(parts_.size());
  for (std::size_t part = 0; part < parts_.size(); ++part) find_starts(part);
  for (std::size_t window = 0; window * kWindow < outline_.held_count(); ++window) {
    load(0, window);
    require_each_run_once(window);
  }
}

// pre: the runs of the window are loaded.
void RunSpool::require_each_run_once(std::size_t window) {
  if (is_refined_) return;
  for (std::size_t i = 0; i < loaded_.size(); ++i)
    if (loaded_[i] == kUnset)
      throw InputError(parts_.front().name, "damaged, or another part is (no part holds run " +
                                                std::to_string(outline_.run_at(window * kWindow + i)) + ")");
}

// Loads the values of an array at all places of a window. A place of no part has the value of a run that is
// not sampled.
void RunSpool::load(std::size_t array, std::size_t window) {
  if (is_loaded_ && loaded_array_ == array && loaded_window_ == window) return;
  const std::string& name = arrays_[array];
  const std::uint64_t none = array == 0        ? kUnset
                             : name == "round" ? bits(std::int32_t{-1})
                             : name == "state" || name == "notes"
                                 ? 0
                                 : bits(std::numeric_limits<double>::quiet_NaN());
  loaded_.assign(std::min(kWindow, outline_.held_count() - window * kWindow), none);
  loaded_array_ = array, loaded_window_ = window, is_loaded_ = true;
  for (std::size_t part = 0; part < parts_.size(); ++part) scatter(array, part);
}

// Copies the values of a part to their places in the loaded window.
void RunSpool::scatter(std::size_t array, std::size_t number) {
  const Part& part = parts_[number];
  const std::size_t first = starts_[number][loaded_window_], end = starts_[number][loaded_window_ + 1];
  for (std::size_t at = first; at < end; at += kBlock) {
    const std::size_t count = std::min(kBlock, end - at);
    const Words runs = get(part, 0, at, count), words = array == 0 ? runs : get(part, array, at, count);
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t& word = loaded_[place_of(runs[i]) - loaded_window_ * kWindow];
      if (array == 0 && word != kUnset)
        throw InputError(part.name,
                         "holds run " + std::to_string(runs[i]) + ", as another part does: expected once");
      word = words[i];
    }
  }
}

std::uint64_t RunSpool::word(std::size_t array, std::size_t place) {
  load(array, place / kWindow);
  return loaded_[place % kWindow];
}

std::vector<std::string> RunSpool::errors(std::size_t first, std::size_t count) const {
  std::vector<std::string> texts(count);
  if (count == 0) return texts;
  const std::uint64_t last = outline_.run_at(first + count - 1);
  for (auto at = errors_.lower_bound(outline_.run_at(first)); at != errors_.end() && at->first <= last; ++at)
    texts[place_of(at->first) - first] = at->second;
  return texts;
}

Values RunSpool::values(const std::string& array, std::size_t first, std::size_t count) {
  if (array == "error") return errors(first, count);
  const std::size_t number = array_number(array);
  if (array == "notes") {
    std::vector<std::uint64_t> notes(count);
    for (std::size_t i = 0; i < count; ++i) notes[i] = word(number, first + i);
    return notes;
  }
  if (array == "state" || array == "round") {
    std::vector<std::int32_t> numbers(count);
    for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::int32_t>(word(number, first + i));
    return numbers;
  }
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = std::bit_cast<double>(word(number, first + i));
  return values;
}

}  // namespace remote_touch
