#include "timbre/analysis/core/mat_file.h"

#include <gtest/gtest.h>

#include <array>
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

// Byte for byte as the description of the format has it.
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

TEST(ToMat, CountsIndicesFromOneAndSaysSo) {
  Eigen::VectorXi map(3);
  map << 4, -1, 0;
  const std::string plain = to_mat({{"map", to_npy(map)}});
  const std::string bytes = to_mat({{"map", to_npy(map), true}});
  EXPECT_EQ(plain.find("index_base"), std::string::npos);
  EXPECT_NE(bytes.find("index_base"), std::string::npos);
  const std::size_t numbers = 128 + 8 + 16 + 16 + 16 + 8;
  EXPECT_EQ(number_at(plain, numbers), 4U);
  EXPECT_EQ(number_at(bytes, numbers), 5U);
  EXPECT_EQ(number_at(bytes, numbers + 4), 0U);
  EXPECT_EQ(number_at(bytes, numbers + 8), 1U);
  EXPECT_EQ(number_at(bytes, bytes.size() - 8), 1U);
}

TEST(ToMat, WritesDoublesByColumnsAndText) {
  Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points(2, 3);
  points << 1, 2, 3, 4, 5, 6;
  const std::string bytes =
      to_mat({{"P", to_npy(points)}, {"version", to_npy(std::string("0.1"))}});
  std::array<double, 6> found{};
  std::memcpy(found.data(), bytes.data() + 128 + 8 + 16 + 16 + 16 + 8, sizeof found);
  EXPECT_EQ(found, (std::array<double, 6>{1, 4, 2, 5, 3, 6}));
  EXPECT_EQ(bytes.substr(bytes.size() - 8), std::string("0\0.\0001\0\0\0", 8));
  EXPECT_EQ(to_mat({{"text", to_npy(std::string())}}).size(), 128U + 8 + 16 + 16 + 16 + 8);
}

TEST(ToMat, RefusesNamesThatAreNone) {
  for (const std::string& name : {std::string(), std::string("1a"), std::string("a-b"),
                                  std::string("_a"), std::string(64, 'a')}) {
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
  EXPECT_EQ(refused_request([] {
              (void)to_mat({{"F", npy_header(5, 2)}});
            }),  // no numbers
            "F: is of a kind that .mat files do not get");
  EXPECT_EQ(refused_request([] {
              (void)to_mat({{"F", to_npy(Eigen::VectorXd(3)), true}});
            }),
            "F: is of a kind that .mat files do not get");
}

}  // namespace
}  // namespace timbre
