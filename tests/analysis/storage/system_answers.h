// Results of write() and rename() in this program, which a test can set.
#pragma once

#include <initializer_list>
#include <vector>

namespace remote_touch {

// The first calls of write() return these answers and write nothing, until this object is destroyed. There
// may be only one object at a time, and only in a test with one thread.
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

// One call of rename() fails with this errno, after calls_before calls that are executed. The effect ends
// with the object.
class FailedRename {
 public:
  FailedRename(int calls_before, int error);
  ~FailedRename();
  FailedRename(const FailedRename&) = delete;
  FailedRename& operator=(const FailedRename&) = delete;
};

}  // namespace remote_touch
