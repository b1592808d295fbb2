// A child process that reads many files. A new process costs a hundred times as much as reading a small file.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "analysis/storage/other_processes.h"

namespace remote_touch::fuzz {

// Runs readers as in_own_child() does, most of them in one process, whose limits count for all that it reads
// together. If the process ended during a question, or had no memory for it, the question is repeated in a
// child of its own. Every crash, lack of memory and end of time is therefore that of one input, and is
// reported as the program reports it.
class LastingChild {
 public:
  LastingChild() = default;
  LastingChild(const LastingChild&) = delete;
  LastingChild& operator=(const LastingChild&) = delete;
  ~LastingChild() { end(); }
  std::string operator()(const ChildLimits& limits, ChildReader reader, const std::string& question);
  int begun() const { return begun_; }        // number of processes so far, one after another
  int repeated() const { return repeated_; }  // number of questions that were repeated

 private:
  struct Answer {
    bool is_failure;
    std::string text;
  };
  void begin(const ChildLimits& limits);
  void end();
  std::optional<Answer> ask(ChildReader reader, const std::string& question);
  pid_t child_ = -1;
  int questions_ = -1, answers_ = -1;  // ends of pipes
  int begun_ = 0, repeated_ = 0;
};

// The way in which targets run the readers that need a child. The default is the program's own way. The
// programs of libFuzzer use a lasting child.
RunInChild& run_in_child();

}  // namespace remote_touch::fuzz
