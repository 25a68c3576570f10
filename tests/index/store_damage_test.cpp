#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <functional>
#include <random>

#include "timbre/analysis/core/error.h"
#include "timbre/index/gallery.h"
#include "timbre/index/store.h"
#include "timbre/tests/support/sample_records.h"
#include "timbre/tests/support/temporary_folder.h"

// What happens to a database when files, disks and processes fail.

namespace timbre {
namespace {

constexpr unsigned kShapes = 8;

ShapeRecord nth(unsigned i) { return sample_record("shape" + std::to_string(i), i, 60, "x"); }

std::string healthy_database(const TemporaryFolder& folder) {
  {
    Store store = Store::create(folder / "healthy");
    for (unsigned i = 0; i < kShapes; ++i) (void)store.add(nth(i));
  }
  return file_content(folder / "healthy");
}

struct Answers {
  int wrong = 0;
  int refused = 0;
};

// Each part may throw; what does not must be right.
Answers ask_everything(const std::string& path) {
  Answers answers;
  const auto part = [&](const std::function<bool()>& is_right) {
    try {
      if (!is_right()) ++answers.wrong;
    } catch (const Error&) {
      ++answers.refused;
    }
  };
  part([&] {
    const Store store = Store::open(path);
    part([&] {
      const auto shapes = store.list();
      bool right = shapes.size() == kShapes;
      for (unsigned i = 0; right && i < kShapes; ++i) {
        right = shapes[i].name == nth(i).name && shapes[i].label == "x";
      }
      return right;
    });
    for (unsigned i = 0; i < kShapes; ++i) {
      const ShapeRecord truth = nth(i);
      part([&] { return store.find(truth.name).has_value(); });
      part([&] { return content_of(store.mesh(truth.name)) == content_of(truth.mesh); });
      part([&] { return store.eigenvalues(truth.name) == truth.eigenvalues; });
      for (const Descriptor& d : truth.descriptors) {
        part([&] { return store.descriptor(truth.name, find_channel(d.channel)) == d.values; });
      }
    }
    for (const Channel& channel : channels()) {
      part([&] { return load_gallery(store, channel).size() == kShapes; });
    }
    return true;
  });
  return answers;
}

TEST(DamagedStore, NeverAnswersWronglyAfterASingleFlippedBit) {
  const TemporaryFolder folder;
  const std::string healthy = healthy_database(folder);
  std::mt19937 draw(7);
  std::uniform_int_distribution<std::size_t> place(0, healthy.size() - 1);
  for (std::size_t round = 0; round < 500; ++round) {
    const std::size_t at = round < 100 ? round : place(draw);  // the header byte by byte
    std::string damaged = healthy;
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << (round * 5 % 8)));
    put_file(folder / "damaged", damaged);
    EXPECT_EQ(ask_everything(folder / "damaged").wrong, 0) << "byte " << at;
  }
}

TEST(DamagedStore, NeverAnswersWronglyAfterBlocksWereLostOrMoved) {
  const TemporaryFolder folder;
  const std::string healthy = healthy_database(folder);
  constexpr std::size_t kPage = 4096;
  std::mt19937 draw(8);
  std::uniform_int_distribution<std::size_t> page(0, healthy.size() / kPage - 1);
  for (int round = 0; round < 60; ++round) {
    std::string damaged = healthy;
    const std::size_t a = page(draw) * kPage;
    const std::size_t b = page(draw) * kPage;
    if (round % 3 == 0) {
      damaged.resize(a);
    } else if (round % 3 == 1) {
      damaged.replace(a, kPage, kPage, '\0');
    } else {
      damaged.replace(a, kPage, healthy, b, kPage);
    }
    put_file(folder / "damaged", damaged);
    EXPECT_EQ(ask_everything(folder / "damaged").wrong, 0) << "round " << round;
  }
}

TEST(DamagedStore, IsReportedByVerifyIfAnythingIsRefused) {
  const TemporaryFolder folder;
  const std::string healthy = healthy_database(folder);
  std::mt19937 draw(9);
  std::uniform_int_distribution<std::size_t> place(0, healthy.size() - 1);
  int reported = 0;
  for (int round = 0; round < 150; ++round) {
    std::string damaged = healthy;
    const std::size_t at = place(draw);
    damaged[at] = static_cast<char>(damaged[at] ^ (1 << round % 8));
    put_file(folder / "damaged", damaged);
    bool clean = false;
    try {
      clean = Store::open(folder / "damaged").verify().damaged.empty();
    } catch (const Error&) {
    }
    if (!clean) {
      ++reported;
      continue;
    }
    EXPECT_EQ(ask_everything(folder / "damaged").refused, 0) << "byte " << at;
  }
  EXPECT_GT(reported, 30);  // most of the others hit bytes that are not in use
}

// Runs `work` in a process of its own; its result is the exit code.
int in_child(const std::function<int()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    int code = 99;
    try {
      code = work();
    } catch (...) {
    }
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(StoreOnAFullDisk, LosesNothingAcknowledgedAndGoesOnAfterwards) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.timbre";
  (void)Store::create(path);
  for (const rlim_t limit : {60000U, 150000U, 400000U}) {
    const auto before = static_cast<int>(Store::open(path).list().size());
    const int stored = in_child([&] {
      ::signal(SIGXFSZ, SIG_IGN);
      const rlimit most = {limit, limit};
      ::setrlimit(RLIMIT_FSIZE, &most);
      Store store = Store::open(path, StoreAccess::write);
      for (int i = before; i < 90; ++i) {
        try {
          (void)store.add(sample_record("s" + std::to_string(i), static_cast<unsigned>(i), 200));
        } catch (const Error& error) {
          return error.kind() == ErrorKind::io && error.file() == path ? i : 98;
        }
      }
      return 97;
    });
    ASSERT_LT(stored, 90);
    Store store = Store::open(path, StoreAccess::write);
    EXPECT_EQ(static_cast<int>(store.list().size()), stored);
    EXPECT_TRUE(store.verify().damaged.empty());
    EXPECT_EQ(
        store.add(sample_record("s" + std::to_string(stored), static_cast<unsigned>(stored), 200)),
        AddOutcome::added);
  }
}

// As a user whom permissions concern.
int without_privilege(const std::function<int()>& work) {
  return in_child([&] {
    constexpr uid_t kNobody = 65534;
    if (::getuid() == 0 && ::setuid(kNobody) != 0) return 98;
    return work();
  });
}

TEST(StoreInAReadOnlyFolder, AnswersAndRefusesToWrite) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.timbre";
  (void)Store::create(path).add(nth(0));
  ::chmod(path.c_str(), 0444);
  ::chmod(folder.path().c_str(), 0555);
  EXPECT_EQ(without_privilege([&] {
              const Store store = Store::open(path);
              return store.list().size() == 1 && store.verify().damaged.empty() ? 0 : 1;
            }),
            0);
  EXPECT_EQ(without_privilege([&] {
              try {
                (void)Store::open(path, StoreAccess::write).add(nth(1));
              } catch (const Error& error) {
                return error.kind() == ErrorKind::io && error.file() == path ? 0 : 1;
              }
              return 2;
            }),
            0);
  ::chmod(folder.path().c_str(), 0755);
}

TEST(StoreInAReadOnlyFolder, DoesNotPassOverAWritersLog) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.timbre";
  (void)Store::create(path).add(nth(0));
  // A writer that dies leaves its log, which holds the second shape.
  ASSERT_EQ(in_child([&] {
              Store store = Store::open(path, StoreAccess::write);
              (void)store.add(nth(1));
              ::_exit(0);
              return 0;
            }),
            0);
  ASSERT_GT(std::filesystem::file_size(path + "-wal"), 0U);
  std::filesystem::remove(path + "-shm");
  ::chmod(folder.path().c_str(), 0555);
  EXPECT_EQ(without_privilege([&] {
              try {
                return static_cast<int>(Store::open(path).list().size());
              } catch (const Error& error) {
                return error.kind() == ErrorKind::io ? 50 : 51;
              }
            }),
            50);
  ::chmod(folder.path().c_str(), 0755);
  EXPECT_EQ(Store::open(path).list().size(), 2U);
}

}  // namespace
}  // namespace timbre
