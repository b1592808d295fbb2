#include "runners/live/devices/haply.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace remote_touch {

std::string HaplyPlace::authority() const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return (is_ipv6 ? "[" + host + "]" : host) + ":" + port;
}

HaplyPlace haply_place(const DeviceAddress& address) {
  HaplyPlace place;
  std::string rest = address.place();
  if (rest.empty()) return place;
  const std::string scheme = "ws://";
  if (rest.compare(0, scheme.size(), scheme) != 0)
    throw address.refusal("is not an address of the Haply service; write ws://HOST:PORT");
  rest.erase(0, scheme.size());
  const std::size_t slash = rest.find('/');
  if (slash != std::string::npos) place.target = rest.substr(slash);
  rest.erase(std::min(slash, rest.size()));
  const std::size_t colon = rest.rfind(':');
  if (colon != std::string::npos && rest.back() != ']') {
    place.port = rest.substr(colon + 1);
    rest.erase(colon);
  }
  if (rest.size() > 2 && rest.front() == '[' && rest.back() == ']') rest = rest.substr(1, rest.size() - 2);
  if (rest.empty() || place.port.empty())
    throw address.refusal("is not an address of the Haply service; write ws://HOST:PORT");
  place.host = rest;
  return place;
}

namespace {

constexpr int kDeepest = 64;  // greatest nesting that is read; more would only fill the stack

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

// Reads JSON text once, front to back, without a copy or an allocation: for messages in a haptic tick. Every
// function returns true if the text matched. The reader must not be used any more after it has returned
// false. Strings and keys are returned as in the text, with their escapes.
class JsonReader {
 public:
  explicit JsonReader(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  // member: bool(std::string_view key), which reads the value or skips it.
  template <class Member>
  bool object(Member member) {
    return items('{', '}', [&] {
      std::string_view key;
      return string(key) && take(':') && member(key);
    });
  }
  // element: bool(), which reads one element or skips it.
  template <class Element>
  bool array(Element element) {
    return items('[', ']', element);
  }

  // Reads a finite number. Returns false if there is none, for instance for NaN, which is not JSON.
  bool number(double& value) {
    const char first = next();
    // The first character is checked, because from_chars also reads "nan" and "inf" as numbers.
    const char* digits = first == '-' ? at_ + 1 : at_;
    if (digits >= end_ || !is_digit(*digits)) return false;
    const auto [end, error] = std::from_chars(at_, end_, value);
    if (error != std::errc() || !std::isfinite(value)) return false;
    at_ = end;
    return true;
  }

  bool boolean(bool& value) {
    value = next() == 't';
    return word(value ? "true" : "false");
  }

  bool string(std::string_view& value) {
    if (!take('"')) return false;
    const char* begin = at_;
    for (; at_ < end_; ++at_) {
      if (*at_ == '"') {
        value = std::string_view(begin, static_cast<std::size_t>(at_++ - begin));
        return true;
      }
      if (*at_ == '\\' && ++at_ == end_) return false;
      if (static_cast<unsigned char>(*at_) < ' ') return false;
    }
    return false;
  }

  bool skip() { return skip(0); }

  bool at_end() { return next() == '\0' && at_ == end_; }

 private:
  template <class Item>
  bool items(char open, char close, Item item) {
    if (!take(open)) return false;
    if (take(close)) return true;
    for (;;) {
      if (!item()) return false;
      if (take(close)) return true;
      if (!take(',')) return false;
    }
  }

  bool skip(int depth) {
    if (depth > kDeepest) return false;
    std::string_view text;
    bool flag = false;
    double value = 0;
    const auto inner = [&] { return skip(depth + 1); };
    switch (next()) {
      case '{':
        return object([&](std::string_view) { return inner(); });
      case '[':
        return array(inner);
      case '"':
        return string(text);
      case 't':
      case 'f':
        return boolean(flag);
      case 'n':
        return word("null");
      default:
        return number(value);
    }
  }

  bool word(std::string_view text) {
    next();
    if (std::string_view(at_, static_cast<std::size_t>(end_ - at_)).substr(0, text.size()) != text)
      return false;
    at_ += text.size();
    return true;
  }

  // Returns the first character after white space; 0 at the end.
  char next() {
    while (at_ < end_ && (*at_ == ' ' || *at_ == '\t' || *at_ == '\n' || *at_ == '\r')) ++at_;
    return at_ < end_ ? *at_ : '\0';
  }

  // Skips c if it is the next character; else returns false.
  bool take(char c) {
    if (next() != c) return false;
    ++at_;
    return true;
  }

  const char* at_;
  const char* end_;
};

constexpr std::size_t kMaxId = 256;

// Reads the members of an object that have these one-letter names and are numbers. Returns false unless every
// name is present.
template <class Vector>
bool components(JsonReader& json, std::string_view names, std::optional<Vector>& found) {
  Vector& value = found.emplace(Vector::Zero());
  unsigned seen = 0;
  const bool read = json.object([&](std::string_view key) {
    const std::size_t i = key.size() == 1 ? names.find(key.front()) : std::string_view::npos;
    if (i == std::string_view::npos) return json.skip();
    seen |= 1u << i;
    return json.number(value[static_cast<int>(i)]);
  });
  return read && seen == (1u << names.size()) - 1;
}

bool read_buttons(JsonReader& json, std::uint32_t& buttons) {
  return json.object([&](std::string_view key) {
    if (key.size() != 1 || key.front() < 'a' || key.front() > 'c') return json.skip();
    bool down = false;
    if (!json.boolean(down)) return false;
    if (down) buttons |= 1u << (key.front() - 'a');
    return true;
  });
}

bool read_device_state(JsonReader& json, HaplyDeviceState& device) {
  return json.object([&](std::string_view key) {
    if (key == "cursor_position") return components(json, "xyz", device.position_m);
    if (key == "cursor_velocity") return components(json, "xyz", device.velocity_m_per_s);
    if (key == "current_cursor_force") return components(json, "xyz", device.force_N);
    return json.skip();
  });
}

bool read_basis(JsonReader& json, HaplyDeviceState& device) {
  return json.object([&](std::string_view key) {
    if (key != "basis") return json.skip();
    return json.object([&](std::string_view inner) {
      return inner == "permutation" ? json.string(device.basis) : json.skip();
    });
  });
}

bool read_device(JsonReader& json, HaplyDeviceState& device) {
  return json.object([&](std::string_view key) {
    if (key == "device_id") return json.string(device.id);
    if (key == "state") return read_device_state(json, device);
    if (key == "config") return read_basis(json, device);
    return json.skip();
  });
}

bool read_handle_state(JsonReader& json, HaplyHandleState& handle) {
  return json.object([&](std::string_view key) {
    if (key == "orientation") return components(json, "xyzw", handle.orientation);
    if (key == "buttons") return read_buttons(json, handle.buttons);
    if (key == "button") {
      bool down = false;
      if (!json.boolean(down)) return false;
      handle.buttons |= down ? 1u : 0u;
      return true;
    }
    return json.skip();
  });
}

bool read_handle(JsonReader& json, HaplyHandleState& handle) {
  return json.object([&](std::string_view key) {
    if (key == "device_id") return json.string(handle.id);
    if (key == "state") return read_handle_state(json, handle);
    return json.skip();
  });
}

// An element is read completely before its id is compared, because the members of an object have no order.
template <class State>
bool read_matching(JsonReader& json, bool (*read)(JsonReader&, State&), std::string_view requested,
                   std::optional<State>& found) {
  return json.array([&] {
    State one;
    if (!read(json, one)) return false;
    if (!found && (requested.empty() || one.id == requested)) found = one;
    return true;
  });
}

}  // namespace

bool read_haply_message(std::string_view text, std::string_view device_id, std::string_view handle_id,
                        HaplyMessage& message) noexcept {
  JsonReader json(text);
  message = {};
  const bool read = json.object([&](std::string_view key) {
    if (key == "inverse3") return read_matching(json, read_device, device_id, message.device);
    if (key == "wireless_verse_grip" || key == "verse_grip")
      return read_matching(json, read_handle, handle_id, message.handle);
    return json.skip();
  });
  return read && json.at_end();
}

void HaplyForceCommand::append(std::string_view text) noexcept {
  std::copy(text.begin(), text.end(), text_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += text.size();
}

bool HaplyForceCommand::set_device(std::string_view id, HaplyForceKey key) noexcept {
  const auto is_plain = [](unsigned char c) { return c >= ' ' && c != '"' && c != '\\'; };
  if (id.empty() || id.size() > kMaxId || !std::all_of(id.begin(), id.end(), is_plain)) return false;
  size_ = 0;
  append(R"({"inverse3":[{"device_id":")");
  append(id);
  append(R"(","commands":{"set_cursor_force":{")");
  append(key == HaplyForceKey::vector ? "vector" : "values");
  append(R"(":{)");
  head_ = size_;
  return true;
}

std::string_view HaplyForceCommand::text(const Vec3& force_N) noexcept {
  size_ = head_;
  for (int i = 0; i < 3; ++i) {
    append(std::array{R"("x":)", R"(,"y":)", R"(,"z":)"}[static_cast<std::size_t>(i)]);
    // Nine digits are at most 16 characters.
    const auto [end, error] = std::to_chars(text_.data() + size_, text_.data() + text_.size(), force_N[i],
                                            std::chars_format::general, 9);
    size_ = static_cast<std::size_t>(end - text_.data());
  }
  append("}}}}]}");
  return {text_.data(), size_};
}

}  // namespace remote_touch
