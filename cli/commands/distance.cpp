#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/stopwatch.h"
#include "timbre/analysis/geodesic/batch.h"
#include "timbre/cli/array_output.h"
#include "timbre/cli/command.h"
#include "timbre/cli/options.h"

namespace timbre::cli {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using SourceSets = std::vector<std::vector<std::int32_t>>;
using Columns = Eigen::Ref<const MatrixXd>;

struct Arguments {
  std::string mesh;
  std::string sources_file;
  std::vector<std::string> vertices;
  DistanceOptions distance;
};

std::int32_t parse_vertex(std::string_view token, const std::string& place) {
  const std::optional<std::int64_t> value = parse_integer(token);
  if (value && *value >= 0 && *value <= std::numeric_limits<std::int32_t>::max()) {
    return static_cast<std::int32_t>(*value);
  }
  throw Error(ErrorKind::bad_input, "", place,
              "'" + std::string(token) + "' is no vertex; 0 is the first");
}

std::vector<std::int32_t> parse_line(std::string_view line, const std::string& place) {
  constexpr std::string_view kBetween = " \t\r,";
  std::vector<std::int32_t> sources;
  line = line.substr(0, line.find('#'));
  while (true) {
    const std::size_t begin = line.find_first_not_of(kBetween);
    if (begin == std::string_view::npos) return sources;
    line.remove_prefix(begin);
    const std::string_view token = line.substr(0, line.find_first_of(kBetween));
    sources.push_back(parse_vertex(token, place));
    line.remove_prefix(token.size());
  }
}

// Source sets, and where each was found: for errors.
struct Sources {
  SourceSets sets;
  std::vector<std::string> places;
};

Sources read_sources(const Context& context, const std::string& path) {
  const std::string bytes =
      read_bytes(path, {.size_limit = context.read.size_limit, .stop = interrupted});
  Sources sources;
  std::string_view rest = bytes;
  for (std::size_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    const std::string place = "line " + std::to_string(number);
    std::vector<std::int32_t> set = parse_line(rest.substr(0, end), place);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (set.empty()) continue;
    sources.sets.push_back(std::move(set));
    sources.places.push_back(place);
  }
  if (sources.sets.empty()) {
    throw Error(ErrorKind::bad_input, "", "sources",
                "none given; a line of vertex numbers is wanted for each column of the result");
  }
  return sources;
}

Sources listed_sources(const std::vector<std::string>& vertices) {
  Sources sources;
  for (const std::string& vertex : vertices) {
    try {
      sources.sets.push_back({parse_vertex(vertex, "--vertices")});
    } catch (const Error& error) {
      throw Error(ErrorKind::bad_request, "", error.place(), error.cause());
    }
    sources.places.emplace_back("--vertices");
  }
  return sources;
}

// Before the library does, with the line.
void require_vertices(const Sources& sources, Index vertices, ErrorKind kind) {
  for (std::size_t i = 0; i < sources.sets.size(); ++i) {
    for (const std::int32_t v : sources.sets[i]) {
      if (v < vertices) continue;
      throw Error(kind, "", sources.places[i],
                  "vertex " + std::to_string(v) + " does not exist; the mesh has " +
                      std::to_string(vertices));
    }
  }
}

struct Summary {
  std::int64_t reached = 0;
  double longest = std::numeric_limits<double>::quiet_NaN();  ///< null in JSON
};

void summarise(const Columns& columns, Summary& summary) {
  for (const double distance : columns.reshaped()) {
    if (!std::isfinite(distance)) continue;
    ++summary.reached;
    summary.longest = std::fmax(summary.longest, distance);
  }
}

// A column is contiguous, and columns follow each other: bytes of the file as they lie.
Summary stream_npy(const Arguments& args, const Context& context, const TriangleMesh& mesh,
                   const SourceSets& sets, const DistanceOptions& options) {
  Summary summary;
  OutputFile file(context.output, context.force);
  const Index rows = mesh.vertices.rows();
  file.write(sets.size() == 1 ? npy_vector_header(rows) : npy_header(rows, std::ssize(sets)));
  const auto take = [&](Index, const Columns& columns) {
    summarise(columns, summary);
    for (const auto& column : columns.colwise()) {
      file.write({reinterpret_cast<const char*>(column.data()),
                  static_cast<std::size_t>(column.size()) * sizeof(double)});
    }
  };
  for_file(args.mesh, [&] { compute_distances(mesh, sets, take, options); });
  file.commit();
  return summary;
}

void run(const Arguments& args, const Context& context) {
  const std::string format = context.output.empty() ? "txt" : array_format(context.output);
  context.require_output();
  const bool from_file = !args.sources_file.empty();
  const auto in_sources = [&](const auto& work) {
    return from_file ? for_file(args.sources_file, work) : work();
  };
  const Sources sources = in_sources([&] {
    return from_file ? read_sources(context, args.sources_file) : listed_sources(args.vertices);
  });
  Stopwatch watch;
  nlohmann::json timings;
  const TriangleMesh mesh = load_mesh(context, args.mesh).mesh;
  timings["read"] = watch.lap();
  const Index n = mesh.vertices.rows();
  in_sources([&] {
    require_vertices(sources, n, from_file ? ErrorKind::bad_input : ErrorKind::bad_request);
    return 0;
  });
  require_fits(context.output, n, std::ssize(sources.sets));

  DistanceOptions options = args.distance;
  options.threads = context.threads;
  options.progress = context.progress();
  Summary summary;
  MatrixXd values;
  if (format == "npy") {
    summary = stream_npy(args, context, mesh, sources.sets, options);
  } else {
    values = for_file(args.mesh, [&] { return compute_distances(mesh, sources.sets, options); });
    summarise(values, summary);
    if (!context.output.empty()) {
      context.write_result(context.output, to_file_bytes(context.output, {{"distances", values}}));
    }
  }
  timings["distances"] = watch.lap();
  nlohmann::json document = {{"mesh", args.mesh},
                             {"method", to_word(options.method)},
                             {"vertices", n},
                             {"sources", sources.sets.size()},
                             {"reached", summary.reached},
                             {"longest", summary.longest},
                             {"timings", timings}};
  std::string text;
  if (!context.output.empty()) {
    document["output"] = context.output;
  } else if (context.json) {
    document["values"] = to_json_rows(values);
  } else {
    text = to_rows_text(values);
  }
  context.answer(document, text);
}

}  // namespace

void add_distance(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command =
      *timbre.add_subcommand("distance", "Geodesic distances of all vertices from given ones");
  command.add_option("MESH", args->mesh, "mesh file, or - for standard input")->required();
  CLI::App& sources = *command.add_option_group("sources")->require_option(1);
  sources.add_option("--sources", args->sources_file,
                     "text file: each line the vertices of one source, from 0; # for comments");
  sources.add_option("--vertices", args->vertices, "each a source by itself: 0,17,42")
      ->delimiter(',');
  add_word_option(command, "--method", args->distance.method,
                  {{"exact", DistanceMethod::exact},
                   {"heat", DistanceMethod::heat},
                   {"graph", DistanceMethod::graph}},
                  "heat: approximate, faster for many sources; graph: too long by 2 %");
  command
      .add_option("--time-factor", args->distance.time_factor,
                  "heat only: how far heat spreads, in squares of the mean edge length")
      ->capture_default_str()
      ->check(number_between(0.01, 1e6));
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.footer(
      "Distances to the nearest vertex of each source, n x sources; inf where there is no way.\n"
      "-o F.npy is written as it is found and may be larger than memory; F.npz, F.mat and F.txt\n"
      "not.\n"
      "Example:\n  timbre distance horse.ply --vertices 0,17 -o horse_distances.npy");
  command.callback([args, &context] { run(*args, context); });
}

}  // namespace timbre::cli
