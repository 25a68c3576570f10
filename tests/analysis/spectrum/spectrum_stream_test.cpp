#include "timbre/analysis/spectrum/spectrum_stream.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/mesh_shapes.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

using Eigen::Index;

// Three components: one of many bands, one of a few pairs, one for the dense solver.
Operator three_spheres() {
  return compute_operator(joined({make_sphere(17), make_sphere(9), make_sphere(3)}));
}

const SpectrumOptions kOptions = {.count = 330};

// All bands that are left, after each other.
Eigen::MatrixXd rest_of(SpectrumStream& stream, Index from, Index rows) {
  std::vector<SpectrumBand> bands;
  for (SpectrumBand band = stream.next(); band.values.size() > 0; band = stream.next()) {
    EXPECT_EQ(band.first, from);
    from += band.values.size();
    bands.push_back(std::move(band));
  }
  EXPECT_EQ(from, stream.count());
  const Index first = bands.empty() ? from : bands[0].first;
  Eigen::MatrixXd all(rows, from - first);
  for (const SpectrumBand& band : bands) {
    all.middleCols(band.first - first, band.values.size()) = band.vectors;
  }
  return all;
}

TEST(SpectrumStream, HandsOutWhatComputeSpectrumReturns) {
  const Operator op = three_spheres();
  const Spectrum whole = compute_spectrum(op, kOptions);
  SpectrumStream stream(op, kOptions);
  EXPECT_EQ(rest_of(stream, 0, op.vertices), whole.vectors);
  const Spectrum found = stream.finish();
  EXPECT_EQ(found.values, whole.values);
  EXPECT_EQ(found.residuals, whole.residuals);
  EXPECT_EQ(found.orthonormality, whole.orthonormality);
  EXPECT_EQ(found.certificate->bound, whole.certificate->bound);
  EXPECT_EQ(found.certificate->count, whole.certificate->count);
  EXPECT_GT(whole.certificate->shifts.size(), 2U);
}

class SavedStream : public testing::Test {
 protected:
  [[nodiscard]] std::string state() const { return folder_ / "state"; }

 private:
  TemporaryFolder folder_;
};

TEST_F(SavedStream, GoesOnWithTheSameBytesFromAnyBand) {
  const Operator op = three_spheres();
  SpectrumStream whole(op, kOptions);
  const Eigen::MatrixXd vectors = rest_of(whole, 0, op.vertices);
  const Spectrum found = whole.finish();
  SpectrumStream stopped(op, kOptions);
  Index done = 0;
  for (int bands = 0;; ++bands) {
    stopped.save(state());
    SpectrumStream resumed(op, kOptions);
    EXPECT_EQ(resumed.resume(state()), done);
    EXPECT_EQ(rest_of(resumed, done, op.vertices), vectors.rightCols(vectors.cols() - done))
        << bands;
    const Spectrum again = resumed.finish();
    EXPECT_EQ(again.values, found.values);
    EXPECT_EQ(again.residuals, found.residuals);
    EXPECT_EQ(again.orthonormality, found.orthonormality);
    EXPECT_EQ(again.certificate->bound, found.certificate->bound);
    const SpectrumBand band = stopped.next();
    if (done == stopped.count()) break;
    done += band.values.size();
    ASSERT_LT(bands, 100);
  }
}

TEST_F(SavedStream, IsRefusedWithAnyBitFlippedOrCutShort) {
  const Operator op = compute_operator(make_sphere(8));
  SpectrumStream stream(op, {.count = 150});
  (void)stream.next();
  stream.save(state());
  const std::string good = file_content(state());
  const auto is_refused = [&](const std::string& bytes) {
    put_file(state(), bytes);
    SpectrumStream resumed(op, {.count = 150});
    try {
      (void)resumed.resume(state());
    } catch (const Error& error) {
      return error.kind() == ErrorKind::bad_input;
    }
    return false;
  };
  for (std::size_t place = 0; place < good.size(); place += 1 + good.size() / 97) {
    std::string bad = good;
    bad[place] = static_cast<char>(bad[place] ^ (1 << (place % 8)));
    EXPECT_TRUE(is_refused(bad)) << place;
  }
  for (std::size_t size = 0; size < good.size(); size += 1 + good.size() / 29) {
    EXPECT_TRUE(is_refused(good.substr(0, size))) << size;
  }
  EXPECT_TRUE(is_refused(good + "x"));
}

TEST_F(SavedStream, BelongsToOneOperatorAndItsOptions) {
  const Operator op = compute_operator(make_sphere(8));
  SpectrumStream stream(op, {.count = 150});
  (void)stream.next();
  stream.save(state());
  const auto refusal = [&](const Operator& other, const SpectrumOptions& options) {
    SpectrumStream resumed(other, options);
    try {
      (void)resumed.resume(state());
    } catch (const Error& error) {
      return std::string(error.cause());
    }
    return std::string();
  };
  const std::string reason = "belongs to another mesh or other options";
  EXPECT_EQ(refusal(op, {.count = 151}), reason);
  EXPECT_EQ(refusal(op, {.count = 150, .tolerance = 1e-5}), reason);
  Operator other = op;
  other.stiffness.coeffRef(0, 0) *= 1.0 + 1e-15;
  EXPECT_EQ(refusal(other, {.count = 150}), reason);
}

}  // namespace
}  // namespace timbre
