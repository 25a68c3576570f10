#include "timbre/analysis/core/array_file.h"

#include <gtest/gtest.h>

#include <cstring>

namespace timbre {
namespace {

TEST(ToNpy, HeaderFillsABlockAndDataFollow) {
  Eigen::MatrixXd matrix(2, 3);
  matrix << 1, 2, 3, 4, 5, 6;
  const std::string bytes = to_npy(matrix);
  EXPECT_EQ(bytes.substr(0, 6), "\x93NUMPY");
  EXPECT_NE(bytes.find("'descr': '<f8', 'fortran_order': True, 'shape': (2, 3)"),
            std::string::npos);
  ASSERT_EQ(bytes.size() % 64, 6 * sizeof(double) % 64);
  double second = 0.0;
  std::memcpy(&second, bytes.data() + bytes.size() - 5 * sizeof(double), sizeof second);
  EXPECT_EQ(second, 4.0);  // column-major
}

TEST(NpyHeader, IsThatOfTheWholeArray) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Ones(5, 3);
  const std::string header = npy_header(5, 3);
  EXPECT_EQ(to_npy(matrix).substr(0, header.size()), header);
  EXPECT_EQ(to_npy(matrix).size(), header.size() + 15 * sizeof(double));
  const std::string of_vector = npy_header(5, 1);
  EXPECT_EQ(to_npy(Eigen::VectorXd(matrix.col(0))).substr(0, of_vector.size()), of_vector);
}

TEST(ToNpy, KeepsTheTypeOfIndices) {
  const std::string bytes = to_npy(Eigen::VectorXi(Eigen::VectorXi::LinSpaced(4, 0, 3)));
  EXPECT_NE(bytes.find("'descr': '<i4', 'fortran_order': False, 'shape': (4,)"), std::string::npos);
}

TEST(ToNpz, IsTheSameBytesEachTime) {
  const std::string array = to_npy(Eigen::VectorXd(Eigen::VectorXd::Ones(3)));
  const std::string zip = to_npz({{"evals", array}, {"mass", array}});
  EXPECT_EQ(zip.substr(0, 4), std::string("PK\x03\x04"));
  EXPECT_EQ(zip, to_npz({{"evals", array}, {"mass", array}}));
  EXPECT_NE(zip.find("evals.npy"), std::string::npos);
}

}  // namespace
}  // namespace timbre
