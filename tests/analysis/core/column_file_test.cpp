#include "timbre/analysis/core/column_file.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

using Eigen::MatrixXd;

class AColumnFile : public testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return folder_ / "columns.npy"; }
  [[nodiscard]] std::string unfinished() const { return ColumnFile::unfinished(path()); }

 private:
  TemporaryFolder folder_;
};

TEST_F(AColumnFile, HoldsTheMatrixWhateverTheOrderOfItsColumns) {
  const MatrixXd matrix = MatrixXd::Random(7, 5);
  ColumnFile file(path(), 7, 5, ElementType::float64, false);
  file.write(2, matrix.rightCols(3));
  file.write(0, matrix.leftCols(2));
  EXPECT_FALSE(std::filesystem::exists(path()));
  file.commit(false);
  EXPECT_EQ(file_content(path()), to_npy(matrix));
  EXPECT_FALSE(std::filesystem::exists(unfinished()));
}

TEST_F(AColumnFile, RoundsToSinglePrecision) {
  const MatrixXd matrix = MatrixXd::Random(7, 5);
  ColumnFile file(path(), 7, 5, ElementType::float32, false);
  file.write(0, matrix);
  file.commit(false);
  EXPECT_EQ(from_npy(file_content(path())), matrix.cast<float>().cast<double>());
}

TEST_F(AColumnFile, KeepsItsColumnsWhenReopened) {
  const MatrixXd matrix = MatrixXd::Random(7, 5);
  {
    ColumnFile file(path(), 7, 5, ElementType::float64, false);
    file.write(0, matrix.leftCols(3));
  }
  ColumnFile file(path(), 7, 5, ElementType::float64, true);
  file.write(3, matrix.rightCols(2));
  file.commit(false);
  EXPECT_EQ(file_content(path()), to_npy(matrix));
}

TEST_F(AColumnFile, IsNotReopenedForAnotherMatrix) {
  const auto reopen = [&](int rows, int cols, ElementType type) {
    const ColumnFile file(path(), rows, cols, type, true);
  };
  EXPECT_THROW(reopen(7, 5, ElementType::float64), Error);  // there is none yet
  { const ColumnFile file(path(), 7, 5, ElementType::float64, false); }
  EXPECT_THROW(reopen(7, 6, ElementType::float64), Error);
  EXPECT_THROW(reopen(8, 5, ElementType::float64), Error);
  EXPECT_THROW(reopen(7, 5, ElementType::float32), Error);
  EXPECT_NO_THROW(reopen(7, 5, ElementType::float64));
}

TEST_F(AColumnFile, ReplacesWhatALinkLeadsToAndKeepsItsMode) {
  const TemporaryFolder elsewhere;
  put_file(elsewhere / "real.npy", "old");
  std::filesystem::permissions(elsewhere / "real.npy", std::filesystem::perms::owner_read |
                                                           std::filesystem::perms::owner_write);
  std::filesystem::create_symlink(elsewhere / "real.npy", path());
  ColumnFile file(path(), 2, 2, ElementType::float64, false);
  file.write(0, MatrixXd::Identity(2, 2));
  EXPECT_TRUE(std::filesystem::exists(elsewhere / "real.npy.unfinished"));
  file.commit(true);
  EXPECT_TRUE(std::filesystem::is_symlink(path()));
  EXPECT_EQ(file_content(elsewhere / "real.npy"), to_npy(MatrixXd(MatrixXd::Identity(2, 2))));
  EXPECT_EQ(std::filesystem::status(path()).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
}

TEST_F(AColumnFile, DoesNotReplaceAFileUnasked) {
  put_file(path(), "mine");
  ColumnFile file(path(), 2, 2, ElementType::float64, false);
  file.write(0, MatrixXd::Identity(2, 2));
  EXPECT_THROW(file.commit(false), Error);
  EXPECT_EQ(file_content(path()), "mine");
  file.commit(true);
  EXPECT_EQ(file_content(path()), to_npy(MatrixXd(MatrixXd::Identity(2, 2))));
}

}  // namespace
}  // namespace timbre
