#include "timbre/analysis/core/array_file.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"

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
  const std::string of_vector = npy_vector_header(5);
  EXPECT_EQ(to_npy(Eigen::VectorXd(matrix.col(0))).substr(0, of_vector.size()), of_vector);
}

TEST(ToNpy, KeepsTheTypeOfIndices) {
  const std::string bytes = to_npy(Eigen::VectorXi(Eigen::VectorXi::LinSpaced(4, 0, 3)));
  EXPECT_NE(bytes.find("'descr': '<i4', 'fortran_order': False, 'shape': (4,)"), std::string::npos);
}

// A file as NumPy would write it.
template <typename Scalar>
std::string npy_file(const std::string& header, const std::vector<Scalar>& data) {
  std::string bytes("\x93NUMPY\x01\x00", 8);
  bytes += static_cast<char>(header.size());
  bytes += '\0';
  bytes += header;
  return bytes.append(reinterpret_cast<const char*>(data.data()), data.size() * sizeof(Scalar));
}

std::string complaint(const std::string& bytes) {
  try {
    (void)from_npy(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

TEST(FromNpy, ReadsBackWhatToNpyWrites) {
  const Eigen::MatrixXd matrix = Eigen::MatrixXd::Random(5, 3);
  EXPECT_EQ(from_npy(to_npy(matrix)), matrix);
  EXPECT_EQ(from_npy(to_npy(Eigen::VectorXd(matrix.col(1)))), matrix.col(1));
  const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor> points = matrix;
  EXPECT_EQ(from_npy(to_npy(points)), matrix);
  const Eigen::VectorXi indices = Eigen::VectorXi::LinSpaced(4, -1, 2);
  EXPECT_EQ(from_npy(to_npy(indices)), indices.cast<double>());
  EXPECT_EQ(from_npy(to_npy(Eigen::MatrixXd(0, 3))).cols(), 3);
}

TEST(FromNpy, ReadsBothOrdersAndAllFourTypes) {
  const Eigen::MatrixXd matrix = (Eigen::MatrixXd(2, 2) << 1, 2, 3, 4).finished();
  const std::string rows = "', 'fortran_order': False, 'shape': (2, 2), }\n";
  EXPECT_EQ(from_npy(npy_file<float>("{'descr': '<f4" + rows, {1, 2, 3, 4})), matrix);
  EXPECT_EQ(from_npy(npy_file<std::int64_t>("{'descr': '<i8" + rows, {1, 2, 3, 4})), matrix);
  EXPECT_EQ(from_npy(npy_file<std::int32_t>("{'descr': '<i4" + rows, {1, 2, 3, 4})), matrix);
  // The order of the keys and the last comma are free.
  EXPECT_EQ(from_npy(npy_file<double>("{'shape':(2,2),'fortran_order':True,'descr':'<f8'}",
                                      {1, 3, 2, 4})),
            matrix);
}

TEST(FromNpy, RefusesWhatItCannotTrust) {
  const std::string good = "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }";
  EXPECT_EQ(complaint(npy_file<double>(good, {1, 2})), "none");
  EXPECT_EQ(complaint(""), "is not a NumPy array");
  EXPECT_EQ(complaint("PK\x03\x04"), "is not a NumPy array");
  EXPECT_EQ(complaint(npy_file<double>(good, {1, 2, 3})),
            "data: is 24 bytes, another size than its header says");
  EXPECT_EQ(complaint(npy_file<double>(good, {1})),
            "data: is 8 bytes, another size than its header says");
  EXPECT_EQ(complaint(npy_file<char>(good, {1, 2, 3})),
            "data: is 3 bytes, another size than its header says");
  EXPECT_EQ(complaint(npy_file<double>("{'descr': '>f8', 'fortran_order': False, 'shape': (2,), }",
                                       {1, 2})),
            "header: gives the type '>f8'; <f8, <f4, <i8 and <i4 are read");
  EXPECT_EQ(
      complaint(npy_file<double>("{'descr': '<f8', 'fortran_order': False, 'shape': (), }", {1})),
      "header: gives the array 0 dimensions; 1 and 2 are read");
  EXPECT_EQ(
      complaint(npy_file<std::int64_t>("{'descr': '<i8', 'fortran_order': False, 'shape': (1,), }",
                                       {std::int64_t{1} << 60})),
      "data: 1152921504606846976 is beyond the integers that a double holds");
  // 2^32 x 2^32 elements would be none at all in 64 bits.
  EXPECT_EQ(complaint(npy_file<double>("{'descr': '<f8', 'fortran_order': False, 'shape': "
                                       "(4294967296, 4294967296), }",
                                       {})),
            "data: is 0 bytes, another size than its header says");
}

TEST(FromNpy, DoesNotWalkThroughRowsOfNothing) {
  const Eigen::MatrixXd matrix = from_npy(npy_file<double>(
      "{'descr': '<f8', 'fortran_order': False, 'shape': (9223372036854775807, 0), }", {}));
  EXPECT_EQ(matrix.rows(), 9223372036854775807);
  EXPECT_EQ(matrix.cols(), 0);
}

TEST(FromNpy, RefusesEveryOtherHeaderInTheSameWords) {
  const std::string words = "header: is not as NumPy writes it";
  for (const char* header :
       {"", "{", "{}", "{'descr': '<f8', 'shape': (2,), }", "{'descr': '<f8', 'descr': '<f8'}",
        "{'descr': '<f8', 'fortran_order': Maybe, 'shape': (2,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-2,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2 2), }",
        "{'descr': '<f8' 'fortran_order': False, 'shape': (2,), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), 'more': 1}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2,), } x", "{'descr': '<f8"}) {
    EXPECT_EQ(complaint(npy_file<double>(header, {1, 2})), words) << header;
  }
  const std::string whole = to_npy(Eigen::VectorXd(Eigen::VectorXd::Ones(3)));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_NE(complaint(whole.substr(0, size)), "none") << size;
  }
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
