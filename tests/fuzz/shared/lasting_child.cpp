#include "tests/fuzz/shared/lasting_child.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <new>
#include <stdexcept>

namespace remote_touch::fuzz {

namespace {

constexpr std::size_t kMaxBytes = std::size_t{1} << 30;

enum class Kind : std::uint8_t { answer, failure, no_memory };

bool write_all(int to, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(to, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    at += written, size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool read_all(int from, void* data, std::size_t size) {
  char* at = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t got = ::read(from, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got, size -= static_cast<std::size_t>(got);
  }
  return true;
}

// A message is a head of fixed size, then a size, and as many bytes.
template <class Head>
bool send(int to, const Head& head, const char* bytes, std::size_t size) {
  return write_all(to, &head, sizeof head) && write_all(to, &size, sizeof size) && write_all(to, bytes, size);
}

template <class Head>
bool receive(int from, Head& head, std::string& bytes) {
  std::size_t size = 0;
  if (!read_all(from, &head, sizeof head) || !read_all(from, &size, sizeof size)) return false;
  if (size > kMaxBytes) return false;  // a child whose memory is damaged may send anything
  bytes.resize(size);
  return read_all(from, bytes.data(), size);
}

// Runs in the child.
[[noreturn]] void answer_all(int questions, int answers) noexcept {
  ChildReader reader = nullptr;
  std::string question;
  bool is_heard = true;
  while (is_heard && receive(questions, reader, question)) try {
      const std::string answer = reader(question);
      is_heard = send(answers, Kind::answer, answer.data(), answer.size());
    } catch (const std::bad_alloc&) {
      is_heard = send(answers, Kind::no_memory, "", 0);
    } catch (const std::exception& error) {
      is_heard = send(answers, Kind::failure, error.what(), std::strlen(error.what()));
    }
  ::_exit(0);
}

}  // namespace

void LastingChild::begin(const ChildLimits& limits) {
  std::signal(SIGPIPE, SIG_IGN);  // a child that has ended is recognised by its missing answer
  int questions[2], answers[2];
  if (::pipe(questions) != 0 || ::pipe(answers) != 0) throw std::runtime_error(std::strerror(errno));
  child_ = ::fork();
  if (child_ == 0) {
    ::close(questions[1]), ::close(answers[0]);
    become_limited_child(limits);
    std::signal(SIGPIPE, SIG_DFL), std::signal(SIGPROF, SIG_DFL);
    answer_all(questions[0], answers[1]);
  }
  const int error = errno;
  ::close(questions[0]), ::close(answers[1]);
  questions_ = questions[1], answers_ = answers[0];
  if (child_ < 0) {
    end();
    throw std::runtime_error(std::strerror(error));
  }
  ++begun_;
}

void LastingChild::end() {
  if (questions_ >= 0) ::close(questions_), ::close(answers_);
  questions_ = answers_ = -1;
  if (child_ < 0) return;
  ::kill(child_, SIGKILL);
  while (::waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
}

std::optional<LastingChild::Answer> LastingChild::ask(ChildReader reader, const std::string& question) {
  Kind kind = Kind::no_memory;
  std::string text;
  if (!send(questions_, reader, question.data(), question.size()) || !receive(answers_, kind, text)) {
    end();
    return std::nullopt;
  }
  if (kind == Kind::no_memory) return std::nullopt;
  return Answer{kind == Kind::failure, std::move(text)};
}

std::string LastingChild::operator()(const ChildLimits& limits, ChildReader reader,
                                     const std::string& question) {
  if (child_ < 0) begin(limits);
  if (const std::optional<Answer> found = ask(reader, question)) {
    if (found->is_failure) throw std::runtime_error(found->text);
    return found->text;
  }
  ++repeated_;
  return in_own_child(limits, reader, question);
}

RunInChild& run_in_child() {
  static RunInChild run = in_own_child;
  return run;
}

}  // namespace remote_touch::fuzz
