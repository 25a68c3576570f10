#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/read_mesh.h"

namespace timbre {

/// The whole error line for bytes that must be refused.
inline std::string refusal(const std::string& bytes, const std::string& name,
                           const ReadOptions& options = {}) {
  try {
    (void)read_mesh_bytes(bytes, name, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::bad_input);
    return error.what();
  }
  return "no error";
}

/// Warnings as `code=count code=count`.
inline std::string codes(const MeshFile& file) {
  std::string text;
  for (const ReadWarning& warning : file.warnings) {
    text += (text.empty() ? "" : " ") + warning.code + "=" + std::to_string(warning.count);
  }
  return text;
}

/// `vertices/triangles` and the warnings.
inline std::string summary(const MeshFile& file) {
  const std::string found = codes(file);
  return std::to_string(file.mesh.vertices.rows()) + "/" + std::to_string(file.mesh.faces.rows()) +
         (found.empty() ? "" : " ") + found;
}

struct Refused {
  std::string bytes;
  std::string line;
};

inline void expect_refused(const std::vector<Refused>& cases, const std::string& name) {
  for (const Refused& c : cases) EXPECT_EQ(refusal(c.bytes, name), name + ": " + c.line) << c.bytes;
}

/// Of a file that ends too soon an error is left, or the whole mesh.
inline void expect_cuts_are_seen(const std::string& bytes, const std::string& name) {
  const MeshFile whole = read_mesh_bytes(bytes, name);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    try {
      const MeshFile cut = read_mesh_bytes(bytes.substr(0, size), name);
      ASSERT_EQ(cut.mesh.vertices.rows(), whole.mesh.vertices.rows()) << size;
      ASSERT_EQ(cut.mesh.faces.rows(), whole.mesh.faces.rows()) << size;
      EXPECT_EQ(cut.mesh.vertices, whole.mesh.vertices) << size;
      EXPECT_EQ(cut.mesh.faces, whole.mesh.faces) << size;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::bad_input) << size;
    }
  }
}

}  // namespace timbre
