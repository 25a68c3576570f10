#include "timbre/index/store.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <thread>

#include "timbre/analysis/core/error.h"
#include "timbre/index/detail/sqlite.h"
#include "timbre/tests/support/sample_records.h"
#include "timbre/tests/support/temporary_folder.h"

namespace timbre {
namespace {

std::string what_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

void tamper(const std::string& path, const std::string& sql) {
  detail::Database(path, detail::DatabaseMode::read_write).run(sql.c_str());
}

std::string folder_listing(const TemporaryFolder& folder) {
  std::string names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names += entry.path().filename().string() + " ";
  }
  return names;
}

TEST(Store, GivesBackEveryBit) {
  const TemporaryFolder folder;
  ShapeRecord record = sample_record("cat", 1, 40, "animal");
  record.mesh.vertices(0, 0) = -0.0;
  record.mesh.vertices(0, 1) = std::numeric_limits<double>::denorm_min();
  {
    Store store = Store::create(folder / "a.timbre");
    EXPECT_EQ(store.add(record), AddOutcome::added);
  }
  const Store store = Store::open(folder / "a.timbre");
  const TriangleMesh mesh = store.mesh("cat");
  EXPECT_EQ(content_of(mesh), content_of(record.mesh));
  EXPECT_TRUE(std::signbit(mesh.vertices(0, 0)));
  EXPECT_EQ(mesh.faces, record.mesh.faces);
  EXPECT_EQ(store.eigenvalues("cat"), record.eigenvalues);
  for (const Descriptor& descriptor : record.descriptors) {
    EXPECT_EQ(store.descriptor("cat", find_channel(descriptor.channel)), descriptor.values);
  }
  const std::vector<ShapeInfo> shapes = store.list();
  ASSERT_EQ(shapes.size(), 1U);
  EXPECT_EQ(shapes[0].name, "cat");
  EXPECT_EQ(shapes[0].label, "animal");
  EXPECT_EQ(shapes[0].vertices, 40);
  EXPECT_EQ(shapes[0].faces, 38);
  EXPECT_EQ(shapes[0].area, 2.0);
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(Store, LeavesOneFileWhenItIsClosed) {
  const TemporaryFolder folder;
  (void)Store::create(folder / "a.timbre").add(sample_record("cat", 1));
  (void)Store::open(folder / "a.timbre").list();
  EXPECT_EQ(folder_listing(folder), "a.timbre ");
}

TEST(Store, HoldsAnEmptyList) {
  const TemporaryFolder folder;
  const Store store = Store::create(folder / "a.timbre", {.count = 50});
  EXPECT_TRUE(store.list().empty());
  EXPECT_EQ(store.verify().checked, 0);
  EXPECT_EQ(Store::open(folder / "a.timbre").parameters(), (StoreParameters{.count = 50}));
}

TEST(StoreAdd, KeepsTheSameAndRefusesOtherContentUnlessToldToReplace) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "a.timbre");
  (void)store.add(sample_record("cat", 1));
  (void)store.add(sample_record("dog", 2));
  EXPECT_EQ(store.add(sample_record("cat", 1)), AddOutcome::kept);
  EXPECT_EQ(store.add(sample_record("cat", 1), true), AddOutcome::kept);
  EXPECT_EQ(what_of([&] { (void)store.add(sample_record("cat", 3)); }),
            folder / "a.timbre" +
                ": 'cat': is there with other content; --replace puts this in its place");
  EXPECT_EQ(content_of(store.mesh("cat")), content_of(sample_record("cat", 1).mesh));
  EXPECT_EQ(store.add(sample_record("cat", 3), true), AddOutcome::replaced);
  EXPECT_EQ(content_of(store.mesh("cat")), content_of(sample_record("cat", 3).mesh));
  EXPECT_EQ(store.add(sample_record("cat", 3, 40, "pet"), true), AddOutcome::replaced);
  EXPECT_EQ(store.find("cat")->label, "pet");
  EXPECT_EQ(store.list()[0].name, "cat");  // in its old place
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(StoreAdd, TakesNamesAsDataAndRefusesWhatCannotBeShown) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "a.timbre");
  for (const char* const name :
       {"'; drop table shape; --", "../x", "%s", "\xd7\x90\xe2\x80\xae", "a b", "\"", "?"}) {
    EXPECT_EQ(store.add(sample_record(name, 1)), AddOutcome::added) << name;
    EXPECT_EQ(store.find(name)->name, name);
  }
  EXPECT_EQ(what_of([&] { (void)store.add(sample_record("", 1)); }), "name: is empty");
  EXPECT_EQ(what_of([&] { (void)store.add(sample_record("a\nb", 1)); }),
            "name: 'a\\nb' holds control characters");
  EXPECT_EQ(what_of([&] { (void)store.add(sample_record(std::string("a\0b", 3), 1)); }),
            "name: 'a\\x00b' holds control characters");
  EXPECT_EQ(what_of([&] { (void)store.add(sample_record("\xff", 1)); }),
            "name: '\xff' is not UTF-8");
  EXPECT_NE(what_of([&] {
              (void)store.add(sample_record(std::string(256, 'a'), 1));
            }).find("is longer than 255 bytes"),
            std::string::npos);
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(StoreRemove, TakesOutAllOfAShape) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "a.timbre");
  for (unsigned i = 0; i < 4; ++i) (void)store.add(sample_record("s" + std::to_string(i), i));
  store.remove("s1");
  EXPECT_FALSE(store.find("s1").has_value());
  EXPECT_EQ(store.list().size(), 3U);
  EXPECT_TRUE(store.verify().damaged.empty());
  EXPECT_EQ(what_of([&] { store.remove("s1"); }), folder / "a.timbre" + ": there is no shape 's1'");
  EXPECT_EQ(what_of([&] { (void)store.mesh("s1"); }),
            folder / "a.timbre" + ": there is no shape 's1'");
  EXPECT_EQ(store.add(sample_record("s1", 1)), AddOutcome::added);
  EXPECT_EQ(store.list().back().name, "s1");
}

TEST(StoreCreate, RefusesWhatIsThereAndPlacesThatAreNot) {
  const TemporaryFolder folder;
  put_file(folder / "there", "x");
  EXPECT_EQ(what_of([&] { (void)Store::create(folder / "there"); }),
            folder / "there" + ": exists already");
  EXPECT_EQ(file_content(folder / "there"), "x");
  EXPECT_NE(what_of([&] {
              (void)Store::create(folder / "no/a.timbre");
            }).find(folder / "no/a.timbre" + ": unable to open database file"),
            std::string::npos);
  EXPECT_NE(what_of([&] { (void)Store::create("postgresql://host/db"); }).find("only local files"),
            std::string::npos);
  EXPECT_EQ(folder_listing(folder), "there ");
}

TEST(StoreOpen, RefusesFilesThatAreNotOurs) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) {
    return what_of([&] { (void)Store::open(folder / name); });
  };
  put_file(folder / "empty", "");
  EXPECT_EQ(refusal("empty"), folder / "empty" + ": not a timbre database");
  put_file(folder / "text", std::string(5000, 'x'));
  EXPECT_EQ(refusal("text"), folder / "text" + ": not a timbre database");
  EXPECT_EQ(refusal("missing"), folder / "missing" + ": No such file or directory");
  EXPECT_EQ(what_of([&] { (void)Store::open(folder.path().string()); }),
            folder.path().string() + ": not a timbre database");
  detail::Database(folder / "other", detail::DatabaseMode::create).run("CREATE TABLE t(x)");
  EXPECT_EQ(refusal("other"), folder / "other" + ": not a timbre database");
}

TEST(StoreOpen, RefusesNewerAndChangedDatabases) {
  const TemporaryFolder folder;
  (void)Store::create(folder / "newer");
  tamper(folder / "newer", "PRAGMA user_version = 2");
  EXPECT_EQ(what_of([&] { (void)Store::open(folder / "newer"); }),
            folder / "newer" + ": has format 2, this timbre reads format 1; use a newer timbre");
  for (const char* const sql :
       {"CREATE TABLE more(x)", "CREATE VIEW v AS SELECT 1", "DROP TABLE blob",
        "CREATE TRIGGER t AFTER INSERT ON shape BEGIN DELETE FROM blob; END"}) {
    std::filesystem::remove(folder / "changed");
    (void)Store::create(folder / "changed");
    tamper(folder / "changed", sql);
    EXPECT_EQ(what_of([&] { (void)Store::open(folder / "changed"); }),
              folder / "changed" + ": not a timbre database: its tables are not ours")
        << sql;
  }
}

TEST(StoreDescriptor, RefusesAnotherVersionAndOtherParameters) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "a.timbre");
  (void)store.add(sample_record("cat", 1));
  Channel channel = find_channel("dna_log");
  channel.version = 2;
  EXPECT_NE(what_of([&] { (void)store.descriptor("cat", channel); })
                .find("channel dna_log: stored with version 1 (count=100 form=logarithm k=200 "
                      "mass=lumped operator=robust), this timbre computes version 2"),
            std::string::npos);
  channel.version = 1;
  channel.parameters["count"] = "50";
  EXPECT_THROW((void)store.descriptor("cat", channel), Error);
}

TEST(Store, FindsRowsThatChangedPlaces) {
  for (const char* const sql :
       {// Bytes with their checksums, from one shape to the other.
        "UPDATE blob SET shape = 3 - shape WHERE channel = 'none';"
        "UPDATE blob SET shape = 9 WHERE channel = 'dna_weyl' AND shape = 1;"
        "UPDATE blob SET shape = 1 WHERE channel = 'dna_weyl' AND shape = 2;"
        "UPDATE blob SET shape = 2 WHERE channel = 'dna_weyl' AND shape = 9",
        // From one channel to another of the same shape.
        "DELETE FROM blob WHERE channel = 'dna_weyl';"
        "UPDATE blob SET channel = 'dna_weyl' WHERE channel = 'dna_log'",
        "UPDATE blob SET version = 2 WHERE channel = 'dna_weyl'",
        "UPDATE blob SET parameters = parameters || ' x=1' WHERE channel = 'dna_weyl'",
        "DELETE FROM blob WHERE channel = 'dna_weyl' AND shape = 2",
        "UPDATE shape SET name = 'cow' WHERE id = 1", "UPDATE shape SET label = 'x'",
        "UPDATE shape SET area = area * 2", "DELETE FROM shape WHERE id = 2",
        "UPDATE shape SET id = 7 WHERE id = 2", "UPDATE meta SET value = '2 ' || value",
        "DELETE FROM meta WHERE key = 'roster'"}) {
    const TemporaryFolder folder;
    {
      Store store = Store::create(folder / "a.timbre");
      (void)store.add(sample_record("cat", 1));
      (void)store.add(sample_record("dog", 2));
    }
    tamper(folder / "a.timbre", sql);
    EXPECT_THROW(
        Store::open(folder / "a.timbre")
            .for_each_descriptor(find_channel("dna_weyl"), [](const auto&, const auto&) {}),
        Error)
        << sql;
    try {
      EXPECT_FALSE(Store::open(folder / "a.timbre").verify().damaged.empty()) << sql;
    } catch (const Error&) {  // parameters that cannot be read: nothing opens at all
    }
  }
}

TEST(Store, SaysWhichShapeIsDamaged) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.timbre";
  {
    Store store = Store::create(path);
    (void)store.add(sample_record("cat", 1));
    (void)store.add(sample_record("dog", 2));
  }
  tamper(path,
         "UPDATE blob SET bytes = zeroblob(length(bytes))"
         " WHERE channel = 'spectrum' AND shape = 2");
  const Store store = Store::open(path);
  EXPECT_EQ(what_of([&] { (void)store.eigenvalues("dog"); }),
            path + ": spectrum of 'dog': checksum differs; run 'timbre db verify " + path + "'");
  EXPECT_EQ(store.eigenvalues("cat").size(), 30);
  const VerifyReport report = store.verify();
  EXPECT_EQ(report.checked, 2);
  ASSERT_EQ(report.damaged.size(), 1U);
  EXPECT_EQ(report.damaged[0].name, "dog");
}

TEST(Store, LetsTwoWritersAddAtOnce) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.timbre";
  (void)Store::create(path);
  const auto write = [&](const std::string& prefix, unsigned seed) {
    Store store = Store::open(path, StoreAccess::write);
    for (unsigned i = 0; i < 25; ++i) {
      (void)store.add(sample_record(prefix + std::to_string(i), seed + i));
    }
  };
  {
    const std::jthread one(write, "a", 0U);
    const std::jthread two(write, "b", 100U);
    for (int i = 0; i < 20; ++i) (void)Store::open(path).list();  // each a state of its own
  }
  const Store store = Store::open(path);
  EXPECT_EQ(store.list().size(), 50U);
  EXPECT_TRUE(store.verify().damaged.empty());
}

TEST(StoreVerify, StopsWhenAsked) {
  const TemporaryFolder folder;
  Store store = Store::create(folder / "a.timbre");
  (void)store.add(sample_record("cat", 1));
  try {
    (void)store.verify([](const ProgressStep&) { return false; });
    FAIL() << "no exception";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::cancelled);
  }
}

}  // namespace
}  // namespace timbre
