#pragma once
/// The only mention of threads. Work is cut into numbered tasks whatever the number of threads, and what a
/// task computes does not depend on who runs it; sums over tasks are formed in task order by the caller. So
/// results are the same bits for any number of threads.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

namespace brio {

/// A fixed team of threads. `for_each` returns when every task is done; it allocates nothing.
class ThreadTeam {
 public:
  /// \param count number of threads, the caller's included; at least 1.
  /// \throws std::system_error if the system does not give so many.
  explicit ThreadTeam(int count = 1);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return static_cast<int>(workers_.size()) + 1; }

  /// Run `task(i)` for i in [0, count), in any order, by any thread of the team. If tasks throw, one of the
  /// exceptions is thrown on when all are done.
  template <class Task>
  void for_each(std::size_t count, Task&& task) {
    if (workers_.empty() || count < 2) {
      for (std::size_t i = 0; i < count; ++i) task(i);
      return;
    }
    using Callable = std::remove_reference_t<Task>;
    run(
        count, [](void* context, std::size_t i) { (*static_cast<Callable*>(context))(i); },
        const_cast<void*>(static_cast<const void*>(&task)));
  }

  /// Run `task(begin, end)` over [0, count) cut into pieces of `grain`; a single piece runs on the caller.
  template <class Task>
  void for_ranges(std::size_t count, std::size_t grain, Task&& task) {
    const std::size_t pieces = (count + grain - 1) / grain;
    for_each(pieces, [&](std::size_t piece) {
      const std::size_t begin = piece * grain;
      task(begin, begin + grain < count ? begin + grain : count);
    });
  }

 private:
  using Call = void (*)(void*, std::size_t);
  void run(std::size_t count, Call call, void* context);
  void work();
  void drain(std::uint32_t loop);
  void stop();

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::exception_ptr fault_;  ///< of a task of the loop that runs
  /// The loop that runs (upper half) and its next task (lower half): a thread that wakes late, when others
  /// have done all tasks of its loop, takes none, and nobody waits for it.
  std::atomic<std::uint64_t> ticket_{0};
  std::atomic<std::size_t> done_{0};  ///< tasks of the loop that are finished
  std::atomic<bool> stop_{false};
  std::atomic<Call> call_{nullptr};
  std::atomic<void*> context_{nullptr};
  std::atomic<std::size_t> count_{0};
};

/// Jobs one after another on a thread of their own, while the caller goes on. The thread starts with the
/// first job and sleeps between jobs: one that has slept is given a busy processor sooner than a new one.
/// After a job that throws, those that wait are dropped.
class BackgroundJobs {
 public:
  BackgroundJobs() = default;
  ~BackgroundJobs();
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  /// \throws std::system_error if the system gives no thread
  void start(std::function<void()> job);
  /// Whether no job runs or waits.
  bool have_ended() const { return unfinished_ == 0; }
  /// Wait until at most so many jobs run or wait. \throws what one has thrown
  void finish(std::size_t left = 0);

 private:
  void work();

  std::thread thread_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  std::exception_ptr fault_;
  std::atomic<std::size_t> unfinished_{0};  ///< written under the mutex
  bool stop_ = false;
};

}  // namespace brio
