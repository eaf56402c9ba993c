#include "apps/ranks.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <climits>
#include <cstdlib>
#include <memory>
#include <vector>

#include "io/yaml/deck_error.hpp"
#include "src/base/index.hpp"

#ifdef BRIO_MPI
#include <mpi.h>
#endif

namespace brio {

namespace {

#ifdef BRIO_MPI

/// A process that fails alone waits so long for others that fail as well.
constexpr std::chrono::seconds patience{5};

class MpiRanks : public Ranks {
 public:
  explicit MpiRanks(MPI_Comm all) : Ranks(number_in(all), count_in(all)), all_(all) {}

 protected:
  void gather(std::span<std::byte> all, std::span<const std::size_t> first) override {
    if (all.size() > INT_MAX) {
      for (int rank = 0; rank < count(); ++rank)
        pass_on(rank, all.subspan(first[index(rank)], first[index(rank) + 1] - first[index(rank)]), true);
      return;
    }
    counts_.clear();
    starts_.clear();
    for (std::size_t rank = 0; rank + 1 < first.size(); ++rank) {
      counts_.push_back(static_cast<int>(first[rank + 1] - first[rank]));
      starts_.push_back(static_cast<int>(first[rank]));
    }
    MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all.data(), counts_.data(), starts_.data(), MPI_BYTE,
                   all_);
  }

  void send_and_receive(std::span<const Message> messages) override {
    open_.clear();
    for (const Message& one : messages)
      in_pieces(one.in.size(), [&](std::size_t at, int size) {
        MPI_Irecv(one.in.data() + at, size, MPI_BYTE, one.rank, 0, all_, &open_.emplace_back());
      });
    for (const Message& one : messages)
      in_pieces(one.out.size(), [&](std::size_t at, int size) {
        MPI_Isend(one.out.data() + at, size, MPI_BYTE, one.rank, 0, all_, &open_.emplace_back());
      });
    MPI_Waitall(static_cast<int>(open_.size()), open_.data(), MPI_STATUSES_IGNORE);
  }

  void pass_on(int from, std::span<std::byte> data, bool to_all) override {
    if (!to_all && (from == 0 || (number() != 0 && number() != from))) return;
    in_pieces(data.size(), [&](std::size_t at, int size) {
      if (to_all)
        MPI_Bcast(data.data() + at, size, MPI_BYTE, from, all_);
      else if (number() == 0)
        MPI_Recv(data.data() + at, size, MPI_BYTE, from, 0, all_, MPI_STATUS_IGNORE);
      else
        MPI_Send(data.data() + at, size, MPI_BYTE, 0, 0, all_);
    });
  }

  int largest_of_all(int value) override {
    int result = value;
    MPI_Allreduce(&value, &result, 1, MPI_INT, MPI_MAX, all_);
    return result;
  }

 private:
  static int number_in(MPI_Comm all) {
    int number = 0;
    MPI_Comm_rank(all, &number);
    return number;
  }
  static int count_in(MPI_Comm all) {
    int count = 0;
    MPI_Comm_size(all, &count);
    return count;
  }

  // Counts of MPI are of type int.
  template <class Piece>
  static void in_pieces(std::size_t size, const Piece& piece) {
    constexpr std::size_t most = std::size_t{1} << 30;
    for (std::size_t at = 0; at < size; at += most) piece(at, static_cast<int>(std::min(most, size - at)));
  }

  MPI_Comm all_;
  std::vector<int> counts_, starts_;
  std::vector<MPI_Request> open_;
};

std::unique_ptr<MpiRanks> joined;
MPI_Comm failing = MPI_COMM_NULL;  // where those that fail wait for each other

#endif

/// Processes that were started together, as Open MPI and MPICH tell; 1: by neither.
int started_together() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* count = std::getenv(name)) return std::atoi(count);
  return 1;
}

}  // namespace

#ifdef BRIO_MPI

Ranks* join_ranks() {
  if (started_together() < 2) return nullptr;
  int provided = 0;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_dup(MPI_COMM_WORLD, &failing);
  joined = std::make_unique<MpiRanks>(MPI_COMM_WORLD);
  return joined->count() > 1 ? joined.get() : nullptr;
}

int processors_of_rank() {
  MPI_Comm here = MPI_COMM_NULL;
  int together = 1;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
  MPI_Comm_size(here, &together);
  MPI_Comm_free(&here);
  cpu_set_t mine;
  const int bound_to = sched_getaffinity(0, sizeof mine, &mine) == 0 ? CPU_COUNT(&mine) : INT_MAX;
  const auto processors = static_cast<int>(sysconf(_SC_NPROCESSORS_ONLN));
  return std::max(1, std::min(bound_to, processors / together));
}

bool ranks_fail_together() {
  if (!joined) return true;
  MPI_Request met = MPI_REQUEST_NULL;
  MPI_Ibarrier(failing, &met);
  const auto begin = std::chrono::steady_clock::now();
  for (int all = 0; all == 0;) {
    MPI_Test(&met, &all, MPI_STATUS_IGNORE);
    if (all != 0) break;
    if (std::chrono::steady_clock::now() - begin > patience) return false;
    usleep(1000);
  }
  return true;
}

void end_all_ranks(int exit_code) {
  MPI_Abort(MPI_COMM_WORLD, exit_code);
  _exit(exit_code);
}

void leave_ranks() {
  if (!joined) return;
  joined.reset();
  MPI_Comm_free(&failing);
  MPI_Finalize();
}

#else

Ranks* join_ranks() {
  if (started_together() > 1)
    throw DeckError(
        "brio: started as one of several processes, but built without MPI; accepted is one process, or a "
        "build configured with -DBRIO_MPI=ON");
  return nullptr;
}

int processors_of_rank() { return 1; }

bool ranks_fail_together() { return true; }

void end_all_ranks(int exit_code) { _exit(exit_code); }

void leave_ranks() {}

#endif

}  // namespace brio
