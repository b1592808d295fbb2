#include "scenarios/text_files/json_text.h"

#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "core/parameters/input_error.h"
#include "scenarios/text_files/refuse.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

namespace {

// Checks every value and key while the text is parsed.
class Watch {
 public:
  explicit Watch(const std::string& label) : label_(label) {}

  void see(int depth, Json::parse_event_t event, const Json& parsed) {
    if (depth > kMaxJsonDepth) refuse(label_, "nested too deep: expected at most ", kMaxJsonDepth, " levels");
    if (event == Json::parse_event_t::object_start) keys_.emplace_back();
    if (event == Json::parse_event_t::object_end) keys_.pop_back();
    if (event == Json::parse_event_t::key && !keys_.back().insert(parsed.get<std::string>()).second)
      refuse(label_, "the key ", shown(parsed), " appears twice in one object: expected each key once");
  }

 private:
  const std::string& label_;
  std::vector<std::set<std::string>> keys_;  // keys so far of each open object
};

// Throws Json::exception if the text is not JSON. The library takes the byte 0 as the end of the text, so the
// callers refuse it.
Json parse_watched(const std::string& text, const std::string& label) {
  Watch watch(label);
  return Json::parse(text, [&](int depth, Json::parse_event_t event, Json& parsed) {
    watch.see(depth, event, parsed);
    return true;
  });
}

}  // namespace

Json parse_json(const std::string& text, const std::string& label) {
  if (const std::size_t at = text.find('\0'); at != std::string::npos)
    refuse(label, "has the byte 0 at byte ", at, ": expected JSON, which is text");
  try {
    return parse_watched(text, label);
  } catch (const Json::exception& error) {
    // "[json.exception...] parse error at line 3, column 4: ..." without the library's own prefix
    std::string what = error.what();
    if (const auto end = what.find("] "); end != std::string::npos) what.erase(0, end + 2);
    refuse(label, what, ": expected JSON with finite numbers");
  }
}

std::optional<Json> json_or_none(const std::string& text, const std::string& label) {
  if (text.find('\0') != std::string::npos) return {};
  try {
    return parse_watched(text, label);
  } catch (const Json::exception&) {
    return {};
  }
}

Json json_in_file(const std::filesystem::path& file) {
  try {
    return json_or_none(read_text_file(file, ""), file.string()).value_or(nullptr);
  } catch (const InputError&) {
    return nullptr;
  }
}

std::string shown(const Json& value) {
  constexpr std::size_t kMaxLength = 160;
  std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > kMaxLength) text.replace(kMaxLength, std::string::npos, "...");
  return text;
}

}  // namespace remote_touch
