// What write() and rename() answer in this program, where a test says so.
#pragma once

#include <initializer_list>
#include <vector>

namespace remote_touch {

// While it lives, the first calls of write() get these answers and write nothing. One at a time, and in a
// test of one thread.
class AnswersOfWrite {
 public:
  struct Answer {
    int written, error;  // error: errno after the call
  };
  AnswersOfWrite(std::initializer_list<Answer> answers);
  ~AnswersOfWrite();
  AnswersOfWrite(const AnswersOfWrite&) = delete;
  AnswersOfWrite& operator=(const AnswersOfWrite&) = delete;

 private:
  std::vector<Answer> answers_;
};

// While it lives, one call of rename() fails, with this errno, after so many that are made.
class FailedRename {
 public:
  FailedRename(int calls_before, int error);
  ~FailedRename();
  FailedRename(const FailedRename&) = delete;
  FailedRename& operator=(const FailedRename&) = delete;
};

}  // namespace remote_touch
