#include <map>

#include "timbre/index/detail/store_impl.h"
#include "timbre/index/detail/text.h"
#include "timbre/index/store.h"

namespace timbre {

using detail::Blob;
using detail::Database;
using detail::Roster;
using detail::Statement;
using detail::Transaction;

namespace {

struct SeenShape {
  ShapeInfo info;
  std::int64_t blobs_expected = 0;
  std::int64_t blobs_seen = 0;
};

// Runs one part of the check; what it throws becomes a finding, and the rest goes on.
template <typename Part>
void note_damage(VerifyReport& report, const std::string& name, const Part& part) {
  try {
    part();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::cancelled) throw;
    const std::string place = error.place().empty() ? "" : error.place() + ": ";
    report.damaged.push_back({name, place + error.cause()});
  }
}

void check_structure(const Database& database, VerifyReport& report) {
  Statement rows(database, "PRAGMA integrity_check(20)");
  while (rows.step()) {
    const std::string line = rows.text(0);
    if (line != "ok") report.damaged.push_back({"", line});
  }
}

void check_meaning(const ShapeInfo& shape, const Blob& blob) {
  if (blob.channel != detail::kMeshBlob) return;
  if (content_of(detail::unpack_mesh(blob.bytes, shape.vertices, shape.faces)) != shape.content) {
    throw Error(ErrorKind::bad_input, "", "mesh", "is not the one that was added");
  }
}

}  // namespace

VerifyReport Store::verify(const Progress& progress) const {
  VerifyReport report;
  const Database& database = impl_->database;
  const Transaction snapshot(database, Transaction::Kind::read);
  note_damage(report, "", [&] { check_structure(database, report); });

  std::map<std::int64_t, SeenShape> shapes;
  Roster seen;
  note_damage(report, "", [&] {
    impl_->for_each_row([&](const Statement& row) {
      ++report.checked;
      note_damage(report, row.text(1), [&] {
        const Impl::Row checked = impl_->checked_row(row);
        seen.put_in(checked.digest);
        shapes[checked.info.id] = {checked.info, checked.blobs, 0};
      });
    });
  });
  note_damage(report, "", [&] {
    if (seen != detail::read_roster(database)) {
      throw Error(ErrorKind::bad_input, "", "", "the list of shapes is not what it was");
    }
  });

  std::int64_t expected = 0;
  for (const auto& [id, shape] : shapes) expected += shape.blobs_expected;
  ProgressReporter reporter(progress, "verify", expected);
  note_damage(report, "", [&] {
    Statement rows(database, "SELECT channel, shape, version, parameters, bytes, sha256 FROM blob");
    while (rows.step()) {
      const auto owner = shapes.find(rows.integer(1));
      const std::string name = owner == shapes.end() ? "" : owner->second.info.name;
      note_damage(report, name, [&] {
        if (owner == shapes.end()) {
          throw Error(ErrorKind::bad_input, "", rows.text(0), "belongs to no undamaged shape");
        }
        ++owner->second.blobs_seen;
        check_meaning(owner->second.info,
                      impl_->checked_blob(owner->second.info, rows.text(0), rows, 2));
      });
      reporter.advance();
    }
  });
  for (const auto& [id, shape] : shapes) {
    if (shape.blobs_seen != shape.blobs_expected) {
      report.damaged.push_back(
          {shape.info.name, "holds " + std::to_string(shape.blobs_seen) + " pieces of data, " +
                                std::to_string(shape.blobs_expected) + " were stored"});
    }
  }
  return report;
}

}  // namespace timbre
