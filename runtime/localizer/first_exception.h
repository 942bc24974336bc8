// Carries an exception out of a thread, where it would end the process.
#pragma once

#include <exception>
#include <mutex>
#include <utility>

namespace plumb::runtime {

class FirstException {
 public:
  // Keeps what `work` throws, if nothing was thrown before. False if it threw.
  template <class Work>
  bool Guard(const Work& work) noexcept {
    try {
      work();
      return true;
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!exception_) exception_ = std::current_exception();
      return false;
    }
  }

  // Once the threads have ended.
  void Rethrow() {
    const std::lock_guard lock(mutex_);
    if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
  }

 private:
  std::mutex mutex_;
  std::exception_ptr exception_;
};

}  // namespace plumb::runtime
