// A file that leads a browser to the page of a live run.
//
// The browser receives this file as its argument and not the address, because the arguments of all processes
// can be read, and whoever has the address can move the hand.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace remote_touch {

class RedirectPage {
 public:
  RedirectPage() = default;
  // Writes a file that only this user can read to the first of the folders that allows it.
  RedirectPage(const std::string& address, const std::vector<std::filesystem::path>& folders);
  ~RedirectPage();  // removes the file
  RedirectPage(RedirectPage&& other) noexcept { file_.swap(other.file_); }
  RedirectPage& operator=(RedirectPage&& other) noexcept {
    file_.swap(other.file_);
    return *this;
  }

  const std::string& file() const { return file_; }  // empty if none of the folders allowed it

 private:
  std::string file_;
};

}  // namespace remote_touch
