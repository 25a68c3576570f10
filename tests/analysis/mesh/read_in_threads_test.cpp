#include <gtest/gtest.h>
#include <zlib.h>

#include <atomic>
#include <clocale>
#include <locale>
#include <thread>

#include "timbre/analysis/mesh/read_mesh.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/read_text.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

std::string stl_text(const TriangleMesh& mesh) {
  std::string text = "solid\n";
  for (const auto& face : mesh.faces.rowwise()) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::int32_t corner : face) {
      text += "vertex";
      for (const double x : mesh.vertices.row(corner)) text += " " + std::to_string(x);
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid\n";
}

std::string stl_binary(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const auto append = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(static_cast<std::uint32_t>(mesh.faces.rows()));
  for (const auto& face : mesh.faces.rowwise()) {
    bytes.append(12, '\0');
    for (const std::int32_t corner : face) {
      for (const double x : mesh.vertices.row(corner)) append(static_cast<float>(x));
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

void put_gzip(const std::string& path, const std::string& content) {
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, content.data(), static_cast<unsigned>(content.size()));
  gzclose(file);
}

// Files of every format, sound and broken.
std::vector<std::string> put_files(const TemporaryFolder& folder) {
  const TriangleMesh mesh = torus(12, 8);
  const std::string off = to_mesh_bytes(mesh, MeshFormat::off);
  put_file(folder / "a.off", off);
  put_file(folder / "a.obj", to_mesh_bytes(mesh, MeshFormat::obj));
  put_file(folder / "a.ply", to_mesh_bytes(mesh, MeshFormat::ply));
  put_file(folder / "text.stl", stl_text(mesh));
  put_file(folder / "binary.stl", stl_binary(mesh));
  put_gzip(folder / "a.off.gz", off);
  put_file(folder / "concave.off", "OFF 4 1 0\n0 0 0\n4 0 0\n1 1.5 0\n0 4 0\n4 0 1 2 3\n");
  put_file(folder / "comma.off", "OFF 1 0 0\n0,5 0 0\n");
  put_file(folder / "cut.ply", to_mesh_bytes(mesh, MeshFormat::ply).substr(0, 2000));
  put_file(folder / "cut.off.gz", file_content(folder / "a.off.gz").substr(0, 200));
  return {folder / "a.off",      folder / "a.obj",     folder / "a.ply",       folder / "text.stl",
          folder / "binary.stl", folder / "a.off.gz",  folder / "concave.off", folder / "comma.off",
          folder / "cut.ply",    folder / "cut.off.gz"};
}

// All there is to know of the outcome.
std::string outcome(const std::string& path) {
  try {
    const MeshFile file = read_mesh(path);
    std::string text = summary(file) + to_mesh_bytes(file.mesh, MeshFormat::obj);
    for (const ReadWarning& warning : file.warnings) text += warning.message;
    return text;
  } catch (const Error& error) {
    return error.what();
  }
}

// Numbers with a comma, thousands apart.
class CommaNumbers : public std::numpunct<char> {
 protected:
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

// A German locale, where the system has one.
void set_comma_locale() {
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "C.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) return;  // NOLINT(concurrency-mt-unsafe)
  }
}

TEST(ReadMesh, GivesTheSameInEightThreadsWhileTheLocaleChanges) {
  const TemporaryFolder folder;
  const std::vector<std::string> files = put_files(folder);
  std::vector<std::string> expected;
  for (const std::string& file : files) expected.push_back(outcome(file));
  ASSERT_EQ(expected[7], files[7] +
                             ": line 2, vertex 0: '0,5' is not a decimal number in the "
                             "range of a double");

  const std::locale before;
  std::atomic<int> at_work = 8;
  std::atomic<int> wrong = 0;
  const auto read_all = [&](std::size_t first) {
    for (std::size_t i = 0; i < 20 * files.size(); ++i) {
      const std::size_t k = (first + i) % files.size();
      if (outcome(files[k]) != expected[k]) ++wrong;
    }
    --at_work;
  };
  const auto change_locale = [&] {
    set_comma_locale();
    const std::locale comma(std::locale::classic(), new CommaNumbers);
    for (bool on = true; at_work > 0; on = !on) {
      std::locale::global(on ? comma : std::locale::classic());
      std::this_thread::yield();
    }
  };
  std::vector<std::thread> threads;
  for (std::size_t first = 0; first < 8; ++first) threads.emplace_back(read_all, first);
  threads.emplace_back(change_locale);
  for (std::thread& thread : threads) thread.join();
  std::locale::global(before);
  std::setlocale(LC_ALL, "C");  // NOLINT(concurrency-mt-unsafe)
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace timbre
