#include "src/base/parallel.hpp"

#include <cassert>

namespace brio {

namespace {

// Waiting spins briefly, because the next loop of a step follows within microseconds, then sleeps.
constexpr int spins_before_sleep = 2000;

inline void pause_briefly() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

ThreadTeam::ThreadTeam(int count) {
  assert(count >= 1);
  workers_.reserve(static_cast<std::size_t>(count - 1));
  for (int i = 1; i < count; ++i) workers_.emplace_back([this] { work(); });
}

ThreadTeam::~ThreadTeam() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    generation_.fetch_add(1);
  }
  wake_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void ThreadTeam::drain() {
  for (std::size_t i = next_.fetch_add(1); i < count_; i = next_.fetch_add(1)) call_(context_, i);
}

void ThreadTeam::run(std::size_t count, Call call, void* context) {
  {
    const std::lock_guard lock(mutex_);
    call_ = call;
    context_ = context;
    count_ = count;
    next_ = 0;
    busy_ = static_cast<int>(workers_.size());
    generation_.fetch_add(1);
  }
  wake_.notify_all();
  drain();
  for (int spin = 0; busy_.load() != 0; ++spin) {
    if (spin < spins_before_sleep) {
      pause_briefly();
    } else {
      std::this_thread::yield();
    }
  }
}

void ThreadTeam::work() {
  std::size_t seen = 0;
  while (true) {
    for (int spin = 0; generation_.load() == seen && spin < spins_before_sleep; ++spin) pause_briefly();
    if (generation_.load() == seen) {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return generation_.load() != seen; });
    }
    ++seen;
    if (stop_) return;
    drain();
    busy_.fetch_sub(1);
  }
}

}  // namespace brio
