#pragma once

#include <map>
#include <string>
#include <string_view>

namespace timbre {

/// Classes of shapes, from a text file of `FILE LABEL ...` lines, columns parted by blanks.
class Labels {
 public:
  Labels() = default;
  /// @param column  which column holds the label; FILE is column 1. `?` stands for none
  /// @throws Error  bad_input for a line that lacks the column, or for a file that is
  ///                given two labels; io
  Labels(const std::string& path, int column);

  /// The label of a mesh file or of a stored shape; empty if the list does not know it.
  /// Compared by base name, first with its ending, then without.
  [[nodiscard]] std::string of(const std::string& file_or_name) const;

 private:
  void add(const std::string& file, const std::string& label);

  std::map<std::string, std::string> by_file_;
  std::map<std::string, std::string> by_stem_;  ///< "\n" where files of one stem disagree
};

/// The name a file gives its shape: without folder, `.gz` and ending.
[[nodiscard]] std::string shape_name_of(std::string_view path);

}  // namespace timbre
