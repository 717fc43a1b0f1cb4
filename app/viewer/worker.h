// SPDX-License-Identifier: Apache-2.0
// A thread of its own for one kind of work, so that the window always answers. Only the newest request
// counts: one that has not been begun when the next comes is dropped.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace catoptric::viewer {

template <class Request, class Result>
class Worker {
 public:
  using Work = std::function<Result(const Request&)>;

  /// `makeWork` is called on the thread, and what it makes is destroyed there too: an OpenGL context belongs
  /// to one thread. `wake` is called, on the thread, after each piece of work.
  Worker(std::function<Work()> makeWork, std::function<void()> wake,
         std::optional<Request> first = std::nullopt)
      : makeWork_(std::move(makeWork)),
        wake_(std::move(wake)),
        request_(std::move(first)),
        thread_([this] { run(); }) {}

  /// Waits for the work in hand.
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      isStopping_ = true;
    }
    changed_.notify_one();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  void ask(Request request) {
    {
      const std::lock_guard lock(mutex_);
      request_ = std::move(request);
    }
    changed_.notify_one();
  }

  /// The newest result that was not taken yet; throws what the work has thrown.
  [[nodiscard]] std::optional<Result> take() {
    const std::lock_guard lock(mutex_);
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(result_, std::nullopt);
  }

  /// True from ask() until its result can be taken.
  [[nodiscard]] bool isBusy() const {
    const std::lock_guard lock(mutex_);
    return isWorking_ || request_.has_value();
  }

 private:
  void run() {
    const Work work = makeWork_();
    std::unique_lock lock(mutex_);
    while (true) {
      changed_.wait(lock, [this] { return isStopping_ || request_.has_value(); });
      if (isStopping_) return;
      const Request request = std::move(*request_);
      request_.reset();
      isWorking_ = true;
      lock.unlock();
      std::optional<Result> result;
      std::exception_ptr failure;
      try {
        result = work(request);
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      isWorking_ = false;
      if (result) result_ = std::move(result);
      failure_ = failure;
      wake_();
    }
  }

  std::function<Work()> makeWork_;
  std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Request> request_;
  std::optional<Result> result_;
  std::exception_ptr failure_;
  bool isWorking_ = false, isStopping_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace catoptric::viewer
