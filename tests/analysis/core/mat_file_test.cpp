#include "timbre/analysis/core/mat_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>

#include "timbre/tests/support/refused_request.h"

namespace timbre {
namespace {

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// Byte for byte as the description of the format has it; tests/cli/results_test.py lets SciPy
// read a whole file, where it is installed.
TEST(ToMat, WritesAMatrixOfNumbers) {
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor> faces(2, 3);
  faces << 1, 2, 3, 4, 5, 6;
  const std::string bytes = to_mat({{"F", to_npy(faces)}});
  EXPECT_EQ(bytes.substr(0, 38), "MATLAB 5.0 MAT-file, written by timbre");
  EXPECT_EQ(bytes.substr(124, 4), std::string("\x00\x01IM", 4));
  ASSERT_EQ(bytes.size(), 128U + 8 + 16 + 16 + 16 + 8 + 24);
  EXPECT_EQ(number_at(bytes, 128), 14U);  // a matrix
  EXPECT_EQ(number_at(bytes, 132), bytes.size() - 136);
  EXPECT_EQ(number_at(bytes, 144), 12U);  // of int32
  EXPECT_EQ(number_at(bytes, 160), 2U);   // rows
  EXPECT_EQ(number_at(bytes, 164), 3U);
  EXPECT_EQ(number_at(bytes, 172), 1U);  // letters of the name
  EXPECT_EQ(bytes.substr(176, 8), std::string("F\0\0\0\0\0\0\0", 8));
  EXPECT_EQ(number_at(bytes, 188), 24U);
  EXPECT_EQ(number_at(bytes, 192), 1U);  // column by column
  EXPECT_EQ(number_at(bytes, 196), 4U);
  EXPECT_EQ(number_at(bytes, 200), 2U);
}

TEST(ToMat, FillsEachPartUpToEightBytes) {
  for (const int size : {0, 1, 2, 3}) {
    const std::string bytes =
        to_mat({{"name", to_npy(Eigen::VectorXi(Eigen::VectorXi::Ones(size)))},
                {"text", to_npy(std::string("abc"))}});
    EXPECT_EQ(bytes.size() % 8, 0U) << size;
  }
}

TEST(ToMat, RefusesNamesThatAreNone) {
  for (const std::string name : {"", "1a", "a-b", "_a", std::string(64, 'a').c_str()}) {
    EXPECT_EQ(refused_request([&] {
                (void)to_mat({{name, to_npy(Eigen::VectorXd(3))}});
              }),
              (name.empty() ? "" : name + ": ") +
                  std::string("cannot be the name of a variable in a .mat file"));
  }
  EXPECT_EQ(refused_request([] {
              (void)to_mat({{"F", npy_header(0, 2, ElementType::float32)}});
            }),
            "F: is of a kind that .mat files do not get");
}

}  // namespace
}  // namespace timbre
