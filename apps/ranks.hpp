#pragma once
/// Processes that mpirun has started together. The only mention of MPI is in ranks.cpp.

#include "src/domains/ranks.hpp"

namespace brio {

/// Join the other processes, before any file is read. \return null where this one is alone. \throws DeckError
/// where others were started beside it, but the program was built without MPI
Ranks* join_ranks();

/// Processors of this machine for each process on it.
int processors_of_rank();

/// For a process that has failed. \return whether all fail together, of the same reason; true alone
bool ranks_fail_together();

/// End all processes, of which this one alone has failed.
[[noreturn]] void end_all_ranks(int exit_code);

/// At the end, if they were joined.
void leave_ranks();

}  // namespace brio
