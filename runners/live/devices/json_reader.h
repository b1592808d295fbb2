// Reads JSON text once, front to back, without a copy or an allocation: for messages in a haptic tick. Every
// function returns true if the text matched. The reader must not be used any more after it has returned
// false. Strings and keys are returned as in the text, with their escapes.
#pragma once

#include <string_view>

namespace remote_touch {

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
  bool number(double& value);
  bool boolean(bool& value);
  bool string(std::string_view& value);
  bool skip() { return skip(0); }
  bool at_end();

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
  bool skip(int depth);
  bool word(std::string_view text);
  char next();        // first character after white space; 0 at the end
  bool take(char c);  // skips c if it is the next character; else false

  const char* at_;
  const char* end_;
};

}  // namespace remote_touch
