#include "timbre/index/ingest.h"

#include <gtest/gtest.h>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/datasets/analytic.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

constexpr StoreParameters kFew = {.count = 12};

std::vector<IngestInput> ellipsoids(const TemporaryFolder& folder, int count) {
  std::vector<IngestInput> inputs;
  for (int i = 0; i < count; ++i) {
    const std::string path = folder / ("e" + std::to_string(i) + ".off");
    write_mesh(make_ellipsoid(1.0, 1.0 + 0.1 * i, 0.7, 2 + i % 3), path, true);
    inputs.push_back({path, "", i % 2 == 0 ? "even" : "odd"});
  }
  return inputs;
}

std::string outcomes(Store& store, const std::vector<IngestInput>& inputs,
                     const IngestOptions& options = {}) {
  std::string text;
  add_files(store, inputs, options, [&](const IngestResult& result) {
    text += result.name + (!result.outcome                        ? "! "
                           : *result.outcome == AddOutcome::added ? "+ "
                           : *result.outcome == AddOutcome::kept  ? "= "
                                                                  : "~ ");
  });
  return text;
}

TEST(AddFiles, GivesTheSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const std::vector<IngestInput> inputs = ellipsoids(folder, 12);
  for (const int threads : {1, 2, 5}) {
    Store store = Store::create(folder / std::to_string(threads), kFew);
    const IngestSummary summary =
        add_files(store, inputs, {.threads = threads}, [](const IngestResult&) {});
    EXPECT_EQ(summary.added, 12);
  }
  {  // each mesh waits until it is alone
    Store store = Store::create(folder / "tight", kFew);
    (void)add_files(store, inputs, {.threads = 2, .memory = 1}, [](const IngestResult&) {});
  }
  EXPECT_EQ(file_content(folder / "1"), file_content(folder / "tight"));
  EXPECT_EQ(Store::open(folder / "1").list()[3].label, "odd");
  EXPECT_EQ(file_content(folder / "1"), file_content(folder / "2"));
  EXPECT_EQ(file_content(folder / "1"), file_content(folder / "5"));
}

TEST(AddFiles, KeepsReportsAndReplaces) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "db", kFew);
  std::vector<IngestInput> inputs = ellipsoids(folder, 3);
  put_file(folder / "broken.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n");
  put_file(folder / "flat.off", "OFF\n3 1 0\n1 0 0\n1 0 0\n1 0 0\n3 0 1 2\n");
  inputs.insert(inputs.begin() + 1, {{folder / "broken.off", "", ""},
                                     {folder / "flat.off", "", ""},
                                     {folder / "missing.off", "", ""},
                                     {folder / "e0.off", "bad\nname", ""}});
  EXPECT_EQ(outcomes(store, inputs), "e0+ broken! flat! missing! bad\nname! e1+ e2+ ");
  EXPECT_EQ(outcomes(store, inputs), "e0= broken! flat! missing! bad\nname! e1= e2= ");
  write_mesh(make_sphere(3), folder / "e1.off", true);
  EXPECT_EQ(outcomes(store, ellipsoids(folder, 1)), "e0= ");
  write_mesh(make_sphere(3), folder / "e1.off", true);
  EXPECT_EQ(outcomes(store, {{folder / "e1.off", "", "odd"}}), "e1! ");
  EXPECT_EQ(outcomes(store, {{folder / "e1.off", "", "odd"}}, {.replace = true}), "e1~ ");
  EXPECT_EQ(outcomes(store, {{folder / "e1.off", "", "new"}}, {.replace = true}), "e1~ ");
  EXPECT_EQ(outcomes(store, {{folder / "e1.off", "", "new"}}, {.replace = true}), "e1= ");
  EXPECT_EQ(store.mesh("e1").vertices.rows(), 92);
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(AddFiles, SaysThatAnotherLabelWasNotTaken) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "db", kFew);
  std::vector<IngestInput> inputs = ellipsoids(folder, 1);
  (void)outcomes(store, inputs);
  inputs[0].label = "other";
  add_files(store, inputs, {}, [](const IngestResult& result) {
    EXPECT_EQ(result.outcome, AddOutcome::kept);
    ASSERT_EQ(result.warnings.size(), 1U);
    EXPECT_EQ(result.warnings[0].message, "keeps its label 'even' without --replace");
  });
}

TEST(AddFiles, NamesTheFileInItsErrors) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "db", kFew);
  put_file(folder / "flat.off", "OFF\n3 1 0\n1 0 0\n1 0 0\n1 0 0\n3 0 1 2\n");
  std::string error;
  const IngestSummary summary =
      add_files(store, {{folder / "flat.off", "", ""}}, {},
                [&](const IngestResult& result) { error = result.error; });
  EXPECT_EQ(summary.failed, 1);
  EXPECT_TRUE(error.starts_with(folder / "flat.off" + ": ")) << error;
}

TEST(AddFiles, StopsWhenAskedAndKeepsWhatItReported) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "db", kFew);
  const std::vector<IngestInput> inputs = ellipsoids(folder, 40);
  std::size_t reported = 0;
  bool stop = false;
  const IngestOptions options = {.threads = 2,
                                 .progress = [&](const ProgressStep&) { return !stop; }};
  try {
    add_files(store, inputs, options, [&](const IngestResult&) {
      ++reported;
      stop = reported >= 3;
    });
    // All shapes may be stored before progress is asked again, a tenth of a second later.
    EXPECT_EQ(reported, 40U);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
  EXPECT_EQ(store.list().size(), reported);
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(AddFiles, DoesNothingForNothing) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "db", kFew);
  EXPECT_EQ(add_files(store, {}, {}, [](const IngestResult&) { FAIL(); }).added, 0);
}

TEST(AddFiles, PassesOnWhatTheCallerThrows) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "db", kFew);
  EXPECT_THROW(add_files(store, ellipsoids(folder, 20), {.threads = 2},
                         [](const IngestResult&) { throw std::runtime_error("enough"); }),
               std::runtime_error);
  EXPECT_EQ(store.list().size(), 1U);
}

}  // namespace
}  // namespace timbre
