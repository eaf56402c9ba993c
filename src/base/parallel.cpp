#include "src/base/parallel.hpp"

#include <cassert>
#include <chrono>
#include <string>
#include <system_error>
#include <utility>

#include "src/base/index.hpp"

namespace brio {

namespace {

// Waiting spins briefly, because the next loop of a step follows within microseconds, then yields, then
// sleeps: to wake a thread takes longer than most loops.
constexpr int spins_before_sleep = 2000, yields_before_sleep = 500;

constexpr int task_bits = 32;
constexpr std::uint64_t task_mask = (std::uint64_t{1} << task_bits) - 1;

constexpr std::uint64_t ticket_of(std::uint32_t loop, std::uint64_t task) {
  return static_cast<std::uint64_t>(loop) << task_bits | task;
}
std::uint32_t loop_of(std::uint64_t ticket) { return static_cast<std::uint32_t>(ticket >> task_bits); }
std::size_t task_of(std::uint64_t ticket) { return index(ticket & task_mask); }

/// Tasks of a share end there, where the next one's begin.
constexpr std::size_t end_of_share(std::size_t tasks, std::size_t share, std::size_t shares) {
  return tasks * (share + 1) / shares;
}

/// Waits while nobody else wants the processor. Who yields to another process gets it back a time slice
/// later, who sleeps and is woken sooner: so for some time after that there is no more yielding.
class Yielding {
 public:
  template <class Condition>
  void wait_until(const Condition& condition) {
    if (waits_without_ > 0) {
      --waits_without_;
      return;
    }
    for (int i = 0; i < yields_before_sleep && !condition(); ++i) {
      const Clock::time_point before = Clock::now();
      std::this_thread::yield();
      if (Clock::now() - before < longest_yield) continue;
      waits_without_ = waits_if_busy;
      return;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::microseconds longest_yield{50};
  static constexpr int waits_if_busy = 1000;
  int waits_without_ = 0;
};

inline void pause_briefly() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

ThreadTeam::ThreadTeam(int count) : share_(index(count)) {
  assert(count >= 1);
  workers_.reserve(index(count - 1));
  try {
    for (int i = 1; i < count; ++i) workers_.emplace_back([this, i] { work(index(i)); });
  } catch (const std::system_error& fault) {
    stop();
    throw std::system_error(fault.code(), "cannot start " + std::to_string(count) + " threads");
  }
}

ThreadTeam::~ThreadTeam() { stop(); }

void ThreadTeam::stop() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  for (auto& worker : workers_) worker.join();
}

// Who takes a task holds the values of its loop: they were written before its ticket was published and are
// not written again before all its tasks are finished and the tickets are closed. A thread that reads values
// of the next loop fails to take a task with the ticket of the last.
void ThreadTeam::drain_share(std::uint32_t loop, std::size_t share) {
  std::atomic<std::uint64_t>& of_share = share_[share].ticket;
  std::uint64_t ticket = of_share.load(std::memory_order_acquire);
  while (loop_of(ticket) == loop) {
    const Call call = call_.load(std::memory_order_relaxed);
    void* const context = context_.load(std::memory_order_relaxed);
    const std::size_t task = task_of(ticket);
    if (task >= end_of_share(count_.load(std::memory_order_acquire), share, share_.size())) return;
    if (!of_share.compare_exchange_weak(ticket, ticket + 1, std::memory_order_acquire)) continue;
    try {
      call(context, task);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      fault_ = std::current_exception();
    }
    done_.fetch_add(1, std::memory_order_release);
    ticket = of_share.load(std::memory_order_acquire);
  }
}

void ThreadTeam::drain(std::uint32_t loop, std::size_t thread) {
  for (std::size_t k = 0; k < share_.size(); ++k) drain_share(loop, (thread + k) % share_.size());
}

void ThreadTeam::run(std::size_t count, Call call, void* context) {
  assert(count < task_mask);
  const std::uint32_t last = loop_.load(std::memory_order_relaxed), loop = last + 1;
  for (Share& share : share_) share.ticket.store(ticket_of(last, task_mask));
  call_.store(call, std::memory_order_relaxed);
  context_.store(context, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  count_.store(count, std::memory_order_release);
  for (std::size_t k = 0; k < share_.size(); ++k)
    share_[k].ticket.store(ticket_of(loop, k == 0 ? 0 : end_of_share(count, k - 1, share_.size())),
                           std::memory_order_release);
  {
    const std::lock_guard lock(mutex_);
    loop_.store(loop, std::memory_order_release);
  }
  wake_.notify_all();
  drain(loop, 0);
  for (int spin = 0; done_.load(std::memory_order_acquire) != count; ++spin) {
    if (spin < spins_before_sleep) {
      pause_briefly();
    } else {
      std::this_thread::yield();
    }
  }
  if (fault_) std::rethrow_exception(std::exchange(fault_, nullptr));
}

void ThreadTeam::work(std::size_t thread) {
  std::uint32_t seen = 0;
  Yielding yielding;
  const auto now = [&] { return loop_.load(std::memory_order_acquire); };
  while (true) {
    const auto goes_on = [&] { return now() != seen || stop_; };
    for (int spin = 0; !goes_on() && spin < spins_before_sleep; ++spin) pause_briefly();
    yielding.wait_until(goes_on);
    if (now() == seen) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, goes_on);
    }
    if (stop_) return;
    seen = now();
    drain(seen, thread);
  }
}

BackgroundJobs::~BackgroundJobs() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void BackgroundJobs::start(std::function<void()> job) {
  if (!thread_.joinable()) thread_ = std::thread([this] { work(); });
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(job));
    ++unfinished_;
  }
  changed_.notify_all();
}

void BackgroundJobs::finish(std::size_t left) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return unfinished_ <= left; });
  if (fault_) std::rethrow_exception(std::exchange(fault_, nullptr));
}

void BackgroundJobs::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return !waiting_.empty() || stop_; });
    if (waiting_.empty()) return;
    const std::function<void()> job = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    std::exception_ptr fault;
    try {
      job();
    } catch (...) {
      fault = std::current_exception();
    }
    lock.lock();
    if (fault) {
      fault_ = fault;
      waiting_.clear();
    }
    unfinished_ = fault ? 0 : unfinished_ - 1;
    changed_.notify_all();
  }
}

}  // namespace brio
