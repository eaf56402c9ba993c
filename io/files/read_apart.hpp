#pragma once
/// Files of unknown origin are read in a child process: HDF5 trusts what a file says, and one that was
/// damaged or made for the purpose can make the library crash, loop or ask for any amount of memory.

#include <filesystem>
#include <functional>
#include <string>

namespace brio {

/// Runs `work`, which reads `file`, in a child process of this one, which is limited in processor time and
/// memory by the size of the file. \return what `work` returns.
/// \throws FileError what `work` throws as FileError; that the file is broken, and how that was seen, where
/// the child process fails in any other way.
std::string read_apart(const std::filesystem::path& file, const std::function<std::string()>& work);

}  // namespace brio
