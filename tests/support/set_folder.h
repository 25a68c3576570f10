#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {

/// A folder that a test fills as a collection of shapes.
class SetFolder : public TemporaryFolder {
 public:
  void put(const std::string& name, const std::string& content) const {
    std::filesystem::create_directories(std::filesystem::path(*this / name).parent_path());
    put_file(*this / name, content);
  }

  /// Tetrahedra under these names.
  void put_meshes(const std::vector<std::string>& names) const {
    for (const std::string& name : names) {
      put(name, "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
    }
  }

  /// What an error says, without this folder.
  [[nodiscard]] std::string without_folder(std::string line) const {
    const std::string folder = path().string();
    for (std::size_t at = line.find(folder); at != std::string::npos; at = line.find(folder)) {
      line.replace(at, folder.size(), "SET");
    }
    return line;
  }
};

/// The error of `work`, folder names replaced by SET.
template <typename Work>
std::string refusal_of(const SetFolder& folder, ErrorKind kind, Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return folder.without_folder(error.what());
  }
  return "no error";
}

}  // namespace timbre
