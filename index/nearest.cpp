#include "timbre/index/nearest.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <flann/flann.hpp>
#include <fstream>
#include <iterator>
#include <mutex>
#include <system_error>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/sha256.h"

namespace timbre {
namespace {

using Tree = flann::Index<flann::L2<float>>;

constexpr int kBranching = 32;
constexpr int kIterations = 5;
constexpr int kChecks = 4096;
constexpr unsigned kSeed = 1;
constexpr std::int64_t kRecallQueries = 200;
constexpr std::int64_t kRecallDepth = 10;
constexpr std::int64_t kRecallCandidates = 500;

// FLANN's seed is rand()'s, of the whole process.
std::mutex build_mutex;

// A file without a name in any folder, which FLANN opens like one with a name.
class MemoryFile {
 public:
  MemoryFile() : descriptor_(::memfd_create("timbre-index", MFD_CLOEXEC)) {
    if (descriptor_ < 0) {
      throw Error(ErrorKind::io, "", "memory file", std::generic_category().message(errno));
    }
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) {
        throw Error(ErrorKind::io, "", "memory file", std::generic_category().message(errno));
      }
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }

 private:
  int descriptor_;
};

std::string content_at(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string digest_text(std::string_view bytes) {
  Sha256 hash;
  hash.add_text("timbre nearest index 1");
  hash.add_text(bytes);
  return to_hex(hash.finish());
}

}  // namespace

struct NearestIndex::Impl {
  std::vector<float> rows;            // of the tree, end to end
  std::vector<std::int64_t> indexed;  // gallery index of each row
  std::vector<std::int64_t> short_ones;
  std::size_t dimension = 0;
  std::string header;  // what the tree was made of and how; the same for the same vectors
  std::unique_ptr<Tree> tree;
  double recall = 1.0;

  explicit Impl(const Gallery& gallery) {
    for (std::int64_t i = 0; i < gallery.size(); ++i) {
      dimension = std::max(dimension, gallery.vector(i).size());
    }
    for (std::int64_t i = 0; i < gallery.size(); ++i) {
      const auto vector = gallery.vector(i);
      if (vector.size() < dimension) {
        short_ones.push_back(i);
        continue;
      }
      indexed.push_back(i);
      for (const double value : vector) rows.push_back(static_cast<float>(value));
    }
    const Channel& channel = gallery.channel();
    header =
        "timbre nearest index 1\nchannel " + channel.name + " " + std::to_string(channel.version) +
        " " + canonical_text(channel.parameters) + "\nrows " + std::to_string(indexed.size()) +
        " of " + std::to_string(dimension) + "\nflann " FLANN_VERSION_ " kmeans++ " +
        std::to_string(kBranching) + " " + std::to_string(kIterations) + " seed " +
        std::to_string(kSeed) + "\nvectors " +
        digest_text({reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof(float)}) +
        "\n";
  }

  [[nodiscard]] flann::Matrix<float> matrix() { return {rows.data(), indexed.size(), dimension}; }

  void build() {
    if (indexed.empty() || dimension == 0) return;
    const std::lock_guard lock(build_mutex);
    flann::seed_random(kSeed);
    // K-means++ centres: with FLANN's default, equal seeds give different trees.
    tree = std::make_unique<Tree>(
        matrix(), flann::KMeansIndexParams(kBranching, kIterations, flann::FLANN_CENTERS_KMEANSPP));
    tree->buildIndex();
  }

  void load(std::string_view payload) {
    if (indexed.empty() || dimension == 0) return;
    const MemoryFile file;
    file.write(payload);
    tree = std::make_unique<Tree>(matrix(), flann::SavedIndexParams(file.path()));
  }

  [[nodiscard]] std::vector<std::int64_t> candidates(std::span<const double> query,
                                                     std::int64_t count) const {
    std::vector<std::int64_t> found = short_ones;
    if (!tree) return found;
    if (query.size() < dimension || count >= static_cast<std::int64_t>(indexed.size())) {
      found.insert(found.end(), indexed.begin(), indexed.end());
      return found;
    }
    std::vector<float> point(dimension);
    std::transform(query.begin(), query.begin() + static_cast<std::ptrdiff_t>(dimension),
                   point.begin(), [](double value) { return static_cast<float>(value); });
    std::vector<std::vector<std::size_t>> rows_found;
    std::vector<std::vector<float>> distances;
    flann::SearchParams search(kChecks);
    search.cores = 1;
    tree->knnSearch(flann::Matrix<float>(point.data(), 1, dimension), rows_found, distances,
                    static_cast<std::size_t>(count), search);
    for (const std::size_t row : rows_found[0]) found.push_back(indexed[row]);
    return found;
  }

  void measure_recall(const Gallery& gallery) {
    const auto size = static_cast<std::int64_t>(indexed.size());
    const std::int64_t queries = std::min(size, kRecallQueries);
    std::int64_t wanted = 0;
    std::int64_t found = 0;
    for (std::int64_t q = 0; q < queries; ++q) {
      const std::int64_t own = indexed[static_cast<std::size_t>(q * size / queries)];
      const auto query = gallery.vector(own);
      const auto truth = rank_all(gallery, query, kRecallDepth, own);
      std::vector<std::int64_t> offered = candidates(query, kRecallCandidates);
      std::erase(offered, own);
      const auto near = rank_candidates(gallery, query, offered, kRecallDepth);
      // By distance: of shapes at equal distance any will do.
      for (std::size_t i = 0; i < truth.size(); ++i) {
        ++wanted;
        if (i < near.size() && near[i].distance <= truth.back().distance) ++found;
      }
    }
    if (wanted > 0) recall = static_cast<double>(found) / static_cast<double>(wanted);
  }
};

NearestIndex::NearestIndex(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
NearestIndex::~NearestIndex() = default;
NearestIndex::NearestIndex(NearestIndex&&) noexcept = default;
NearestIndex& NearestIndex::operator=(NearestIndex&&) noexcept = default;

NearestIndex::NearestIndex(const Gallery& gallery) : impl_(std::make_unique<Impl>(gallery)) {
  impl_->build();
  impl_->measure_recall(gallery);
}

std::vector<std::int64_t> NearestIndex::candidates(std::span<const double> query,
                                                   std::int64_t count) const {
  return impl_->candidates(query, count);
}

double NearestIndex::recall() const { return impl_->recall; }

std::string NearestIndex::to_bytes() const {
  std::string bytes = impl_->header;
  const auto recall = std::bit_cast<std::array<char, sizeof(double)>>(impl_->recall);
  bytes.append(recall.begin(), recall.end());
  if (impl_->tree) {
    const MemoryFile file;
    impl_->tree->save(file.path());
    bytes += content_at(file.path());
  }
  return bytes + digest_text(bytes);
}

std::optional<NearestIndex> NearestIndex::from_bytes(const Gallery& gallery,
                                                     std::string_view bytes) {
  auto impl = std::make_unique<Impl>(gallery);
  constexpr std::size_t kDigest = 64;
  if (bytes.size() < impl->header.size() + sizeof(double) + kDigest) return std::nullopt;
  // FLANN trusts its file to the byte; nothing of it is used before all of it is checked.
  const std::string_view content = bytes.substr(0, bytes.size() - kDigest);
  if (digest_text(content) != bytes.substr(content.size())) return std::nullopt;
  if (!content.starts_with(impl->header)) return std::nullopt;
  std::memcpy(&impl->recall, content.data() + impl->header.size(), sizeof(double));
  impl->load(content.substr(impl->header.size() + sizeof(double)));
  return NearestIndex(std::move(impl));
}

std::string nearest_cache_path(const std::string& location, const Channel& channel) {
  return location + "." + channel.name + ".index";
}

NearestIndex open_nearest(const Gallery& gallery, const std::string& path,
                          const std::function<void(const std::string&)>& note) {
  const bool present = std::filesystem::exists(path);
  if (present) {
    if (auto kept = NearestIndex::from_bytes(gallery, content_at(path))) return *std::move(kept);
    if (note) note(path + ": is old or damaged; building it anew");
  }
  NearestIndex built(gallery);
  try {
    write_file(path, built.to_bytes(), true);
  } catch (const Error& error) {
    if (note) note(std::string(error.what()) + "; going on without keeping the index");
  }
  return built;
}

}  // namespace timbre
