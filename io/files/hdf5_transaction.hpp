#pragma once
/// A file driver for HDF5 under which a file changes from one complete state to the next, or not at all.
///
/// HDF5 overwrites its index nodes and headers in place, in no order that a reader of a half-written file
/// could live with: when a process is killed or a disk is full in the middle of that, data written long
/// before can be lost. Under this driver
///   - new bytes go beyond the end of the last committed state, straight to the file;
///   - raw data goes straight to its place (an append never changes rows that were there before);
///   - every other change to committed bytes waits in memory until HDF5 flushes, and is then applied in an
///     order in which each single write leaves a file that reads as before: the superblock (it only learns of
///     a longer file), then index nodes from the root down (a parent knows a new child before its sibling
///     forgets the rows that moved there), then headers by address. An index node lies within one page of the
///     file, because a kill takes effect between the pages of a write;
///   - when anything could not be written, nothing that waits is applied, and closing cuts the file back to
///     its last committed length. HDF5 is not told of the failure: it closes in peace, and the owner asks
///     afterwards.
/// A reader that opens the file meets a lock only while changes are applied.
///
/// This guards against the death of the process. Against that of the machine, `transaction_sync` has every
/// commit forced to the disk, new bytes before the changes that refer to them: what was committed then stays,
/// unless the machine dies within the milliseconds in which changes are applied. Without it a crash of the
/// machine can take what the system had not written yet, up to the whole file.

#include <hdf5.h>

namespace brio {

/// File-access properties that select the driver; to be closed with H5Pclose. Negative when HDF5 refuses.
hid_t transaction_access();

/// The error number (errno) of the first write that failed in `file`, which was opened with
/// `transaction_access()`; 0 when there was none.
int transaction_error(hid_t file);

/// Force every commit to the disk from now on.
void transaction_sync(hid_t file);

/// Whether `path` still names the file that is open.
bool transaction_is_at(hid_t file, const char* path);

/// Do not write anything any more; on closing, return to the last committed state.
void transaction_discard(hid_t file);

}  // namespace brio
