#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <string_view>

namespace timbre {

/// What went wrong, in the terms a program acts on; the words are in `Error`.
enum class ErrorKind : std::uint8_t {
  bad_input,      ///< the file or the mesh cannot mean what was asked
  bad_request,    ///< an option contradicts another, or the input's size
  io,             ///< the system refused: permission, full disk, closed pipe
  not_converged,  ///< the answer exists, but could not be proved
  cancelled,      ///< the caller asked to stop
};

/// The one exception of the library. `what()` is a whole line for a person:
/// `scan_07.ply: vertex 5120: coordinate is not finite`.
/// Parts that are unknown are left empty and drop out of the line. Control
/// characters are escaped, so that the line stays one line.
class Error : public std::exception {
 public:
  Error(ErrorKind kind, std::string file, std::string place, std::string cause);

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] const std::string& place() const noexcept { return place_; }
  [[nodiscard]] const std::string& cause() const noexcept { return cause_; }
  [[nodiscard]] const char* what() const noexcept override { return line_.c_str(); }

  /// The same error, told by a caller who knows the file's name.
  [[nodiscard]] Error in_file(std::string file) const;

 private:
  ErrorKind kind_;
  std::string file_, place_, cause_, line_;
};

/// Control characters as `\n`, `\t` or `\x1b`; all other bytes as they are.
[[nodiscard]] std::string escape_control(std::string_view text);

}  // namespace timbre
