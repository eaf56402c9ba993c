#pragma once
/// Faults of the file system, called up at will: the test program's own pwrite, write, ftruncate and rename
/// stand before those of the C library.

namespace brio::test {

enum class Fault {
  none,
  kill,      ///< the process dies in place of the operation, or between two pages of a write
  no_space,  ///< this and every later write finds the disk full
};

/// The fault strikes at operation number `at`, counted from 0 from here on.
void plan_fault(Fault fault, int at);

/// Operations since the last plan.
int operations_since_plan();
/// Calls of fsync and fdatasync.
int syncs_since_plan();

}  // namespace brio::test
