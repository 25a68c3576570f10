#pragma once

#include <memory>
#include <string>
#include <string_view>

namespace timbre {

/// Writes a whole file so that others find the old content or the new, never a
/// part: a temporary name in the same folder, fsync, rename, fsync of the folder.
/// Of a link the file behind it is replaced; a file that is replaced keeps its mode.
///
/// @param overwrite  false: a file that is there already is an error
/// @throws Error  io, with what the system said; bad_request if the file exists, or if
///                a device, a pipe or a broken link is in its place
void write_file(const std::string& path, std::string_view content, bool overwrite);

/// A file written piece by piece, as `write_file` does: nobody sees it before `commit`, and
/// nothing is left of it without.
class OutputFile {
 public:
  /// @throws Error  as `write_file`
  OutputFile(const std::string& path, bool overwrite);
  ~OutputFile();
  OutputFile(OutputFile&&) noexcept;
  OutputFile& operator=(OutputFile&&) noexcept;

  /// @throws Error  io
  void write(std::string_view content);
  /// Gives the file its name; once, and last.
  /// @throws Error  io; bad_request if there is a file of that name by now
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Gives a file that is complete and synchronised its name, as `write_file` does.
///
/// @param from  in the folder of `path`, or of the file that it is a link to
/// @throws Error  io; bad_request if `path` exists and is not to be replaced
void put_in_place(const std::string& from, const std::string& path, bool overwrite);

/// Throws what `write_file` would, as far as it can be known without writing: to be called
/// before long work.
void require_writable(const std::string& path, bool overwrite);

}  // namespace timbre
