#pragma once

#include <string>
#include <string_view>

namespace timbre {

/// Writes a whole file so that others find the old content or the new, never a
/// part: a temporary name in the same folder, fsync, rename, fsync of the folder.
///
/// @param overwrite  false: a file that is there already is an error
/// @throws Error  io, with what the system said; bad_request if the file exists
void write_file(const std::string& path, std::string_view content, bool overwrite);

}  // namespace timbre
