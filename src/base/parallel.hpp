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
  /// Contiguous tasks that one thread begins with; those who have done their own go on with those of others.
  /// So a thread finds in its cache, in most loops over the same data, what it has left there.
  struct alignas(64) Share {
    std::atomic<std::uint64_t> ticket{0};  ///< the loop (upper half) and the next task of the share
  };
  void run(std::size_t count, Call call, void* context);
  void work(std::size_t thread);
  void drain(std::uint32_t loop, std::size_t thread);
  void drain_share(std::uint32_t loop, std::size_t share);
  void stop();

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::exception_ptr fault_;  ///< of a task of the loop that runs
  /// A thread that wakes late, when others have done all tasks of its loop, takes none, and nobody waits for
  /// it.
  std::vector<Share> share_;            ///< of each thread; the caller's is the first
  std::atomic<std::uint32_t> loop_{0};  ///< that runs
  std::atomic<std::size_t> done_{0};    ///< tasks of the loop that are finished
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
