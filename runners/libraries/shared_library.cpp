#include "runners/libraries/shared_library.h"

#include <dlfcn.h>
#include <cstdlib>
#include <thread>
#include <utility>
#include <vector>

#include "core/parameters/parameter.h"

namespace remote_touch {

namespace {

// Returns the loader's error for the last name that it tried, without that name.
std::string loader_says(const std::string& name) {
  const char* told = dlerror();
  const std::string text = told != nullptr ? told : "no reason given";
  return text.rfind(name + ": ", 0) == 0 ? text.substr(name.size() + 2) : text;
}

// Successive names that fail for the same reason are put together. If there are more than three of them, the
// middle ones are left out:
// "a.so, a.so.9 to a.so.1: no such file; b.so: not for this machine".
std::string failed_names(const std::vector<std::pair<std::string, std::string>>& failures) {
  std::string text;
  for (std::size_t begin = 0, end = 0; begin < failures.size(); begin = end) {
    const auto& [name, reason] = failures[begin];
    while (end < failures.size() && failures[end].second == reason) ++end;
    text += (begin == 0 ? "" : "; ") + name;
    if (end - begin > 1) text += ", " + failures[begin + 1].first;
    if (end - begin > 2) text += " to " + failures[end - 1].first;
    text += ": " + reason;
  }
  return text;
}

}  // namespace

SharedLibrary::SharedLibrary(const Lookup& lookup) : variable_(lookup.variable) {
  // The environment is read here and not in runners/interfaces/cli, because the variable belongs to the
  // loading of libraries, as LD_LIBRARY_PATH does. Only the devices know the names of these variables.
  const char* named = std::getenv(variable_);
  const bool is_named = named != nullptr && *named != '\0';
  const std::vector<std::string> names = is_named ? std::vector<std::string>{named} : lookup.names;
  std::vector<std::pair<std::string, std::string>> failures;
  for (const std::string& name : names) {
    handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle_ != nullptr) {
      file_ = name;
      return;
    }
    failures.emplace_back(name, loader_says(name));
  }
  const std::string variable = variable_;
  throw InputError(names.front(),
                   "cannot be loaded (" + failed_names(failures) + "); " +
                       (is_named ? variable + " must name the library of "
                                 : "install it or let " + variable + " name its file: it is part of ") +
                       lookup.package);
}

SharedLibrary::Function SharedLibrary::operator[](const char* name) const {
  const Function found = optional(name);
  if (found.address == nullptr)
    throw InputError(file_, std::string("has no function ") + name +
                                ": it is too old or another library; set " + variable_ +
                                " to the file of the right one");
  return found;
}

SharedLibrary::Function SharedLibrary::optional(const char* name) const {
  return {dlsym(handle_, name)};
}

LastingThread::LastingThread() : shared_(std::make_shared<Shared>()) {
  // The thread is detached, because a thread that hangs can never be joined.
  std::thread([shared = shared_] { serve(shared); }).detach();
}

LastingThread::~LastingThread() {
  const std::lock_guard lock(shared_->mutex);
  shared_->is_over = true;
  shared_->changed.notify_all();
}

void LastingThread::serve(const std::shared_ptr<Shared>& shared) {
  std::unique_lock lock(shared->mutex);
  for (;;) {
    shared->changed.wait(lock, [&] { return shared->work || shared->is_over; });
    if (!shared->work) return;
    const std::function<void()> work = shared->work;
    lock.unlock();
    std::exception_ptr thrown;
    try {
      work();
    } catch (...) {
      thrown = std::current_exception();
    }
    lock.lock();
    shared->thrown = thrown;
    shared->work = nullptr;
    shared->changed.notify_all();
  }
}

bool LastingThread::run(std::function<void()> work, std::optional<std::chrono::milliseconds> limit) {
  std::unique_lock lock(shared_->mutex);
  shared_->work = std::move(work);
  shared_->changed.notify_all();
  const auto is_done = [&] { return !shared_->work; };
  if (!limit)
    shared_->changed.wait(lock, is_done);
  else if (!shared_->changed.wait_for(lock, *limit, is_done))
    return false;
  if (const std::exception_ptr thrown = std::exchange(shared_->thrown, nullptr))
    std::rethrow_exception(thrown);
  return true;
}

std::shared_ptr<LastingThread> lasting_thread() {
  struct Idle {
    std::mutex mutex;
    std::vector<std::unique_ptr<LastingThread>> threads;
  };
  static Idle& idle = *new Idle;  // never freed: its threads end with the process
  const std::lock_guard lock(idle.mutex);
  if (idle.threads.empty()) idle.threads.push_back(std::make_unique<LastingThread>());
  std::unique_ptr<LastingThread> one = std::move(idle.threads.back());
  idle.threads.pop_back();
  return {one.release(), [](LastingThread* back) {
            const std::lock_guard locked(idle.mutex);
            idle.threads.emplace_back(back);
          }};
}

}  // namespace remote_touch
