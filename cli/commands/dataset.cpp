#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/core/threads.h"
#include "timbre/analysis/mesh/write_mesh.h"
#include "timbre/cli/command.h"
#include "timbre/cli/options.h"
#include "timbre/datasets/analytic.h"
#include "timbre/datasets/articulated.h"
#include "timbre/datasets/random.h"

namespace timbre::cli {
namespace {

namespace fs = std::filesystem;

struct CreatureArguments {
  std::vector<std::string> species = species_names();
  int poses = 6;
  std::string format = "ply";
  ArticulatedOptions options = {.shuffle = true};
};

const std::map<std::string, MeshFormat>& formats() {
  static const std::map<std::string, MeshFormat> kFormats = {
      {"ply", MeshFormat::ply}, {"off", MeshFormat::off}, {"obj", MeshFormat::obj}};
  return kFormats;
}

// Counts work done on any thread, and reports it from the caller's.
class SharedProgress {
 public:
  SharedProgress(const Progress& progress, const std::string& phase, std::size_t total)
      : reporter_(progress, phase, static_cast<std::int64_t>(total)) {}

  void advance() {
    const std::int64_t done = ++done_;
    if (std::this_thread::get_id() == caller_) reporter_.advance_to(done);
  }

 private:
  ProgressReporter reporter_;
  std::atomic<std::int64_t> done_{0};
  std::thread::id caller_ = std::this_thread::get_id();
};

void require_free_folder(const Context& context) {
  if (context.output == "-") {
    throw Error(ErrorKind::bad_request, "", "output", "a folder is needed, not standard output");
  }
  std::error_code failure;
  if (context.force || !fs::exists(context.output, failure)) return;
  const bool empty =
      fs::is_directory(context.output, failure) && fs::is_empty(context.output, failure);
  if (failure) throw Error(ErrorKind::io, context.output, "", failure.message());
  if (!empty) {
    throw Error(ErrorKind::bad_request, context.output, "",
                "is there already, and no empty folder; --force lets files in it be replaced");
  }
}

void create_folder(const Context& context) {
  std::error_code failure;
  fs::create_directories(context.output, failure);
  if (failure) throw Error(ErrorKind::io, context.output, "", failure.message());
  require_writable((fs::path(context.output) / "labels.txt").string(), context.force);
}

// One line for each template vertex: the vertex it became, counted from 1.
std::string truth_lines(const ArticulatedShape& shape) {
  std::string text;
  for (const std::int32_t v : shape.vertex_of_template) text += std::to_string(v + 1) + "\n";
  return text;
}

// A column for each species; 0 where one has fewer vertices than another.
std::string symmetry_table(const std::vector<ArticulatedBody>& bodies) {
  std::string text;
  std::size_t rows = 0;
  for (const ArticulatedBody& body : bodies) {
    text += (text.empty() ? "" : " ") + body.species;
    rows = std::max(rows, body.mirror.size());
  }
  text += "\n";
  for (std::size_t t = 0; t < rows; ++t) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const std::vector<std::int32_t>& mirror = bodies[b].mirror;
      if (b > 0) text += ' ';
      text += std::to_string(t < mirror.size() ? mirror[t] + 1 : 0);
    }
    text += '\n';
  }
  return text;
}

// All pairs of poses of one species, in random order, so that the first lines are a fair
// sample.
std::string pair_lines(const CreatureArguments& args) {
  Random random("pairs", {args.options.seed});
  std::vector<std::string> lines;
  const auto file = [&](const std::string& species, int pose) {
    return species + std::to_string(pose) + "." + args.format;
  };
  for (const std::string& species : args.species) {
    for (int a = 0; a < args.poses; ++a) {
      for (int b = a + 1; b < args.poses; ++b) {
        const bool turned = random.uniform(0.0, 1.0) < 0.5;
        lines.push_back(file(species, turned ? b : a) + " " + file(species, turned ? a : b) + "\n");
      }
    }
  }
  std::string text;
  for (const std::int32_t i : random.permutation(static_cast<std::int32_t>(lines.size()))) {
    text += lines[static_cast<std::size_t>(i)];
  }
  return text;
}

std::vector<ArticulatedBody> make_bodies(const CreatureArguments& args, const Context& context) {
  std::vector<ArticulatedBody> bodies(args.species.size());
  const Progress progress = context.progress();
  SharedProgress shared(progress, "bodies", bodies.size());
  parallel_for(static_cast<std::int64_t>(bodies.size()), context.threads, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    bodies[at] = make_articulated_body(args.species[at], args.options);
    shared.advance();
  });
  return bodies;
}

struct WrittenShape {
  std::string file, species;
  int pose = 0;
  Eigen::Index vertices = 0, faces = 0;
};

std::vector<WrittenShape> write_shapes(const CreatureArguments& args, const Context& context,
                                       const std::vector<ArticulatedBody>& bodies) {
  const auto poses = static_cast<std::size_t>(args.poses);
  std::vector<WrittenShape> written(bodies.size() * poses);
  const Progress progress = context.progress();
  SharedProgress shared(progress, "shapes", written.size());
  parallel_for(static_cast<std::int64_t>(written.size()), context.threads, [&](std::int64_t i) {
    const auto at = static_cast<std::size_t>(i);
    const ArticulatedShape shape =
        make_articulated(bodies[at / poses], static_cast<int>(at % poses), args.options);
    const std::string name = shape.species + std::to_string(shape.pose);
    const std::string stem = (fs::path(context.output) / name).string();
    context.write_result(stem + "." + args.format,
                         to_mesh_bytes(shape.mesh, formats().at(args.format)));
    context.write_result(stem + ".vts", truth_lines(shape));
    written[at] = {name + "." + args.format, shape.species, shape.pose, shape.mesh.vertices.rows(),
                   shape.mesh.faces.rows()};
    shared.advance();
  });
  return written;
}

void require_distinct(std::vector<std::string> species) {
  std::sort(species.begin(), species.end());
  const auto twice = std::adjacent_find(species.begin(), species.end());
  if (twice == species.end()) return;
  throw Error(ErrorKind::bad_request, "", "species", "'" + *twice + "' is named twice");
}

void make_creatures(const CreatureArguments& args, const Context& context) {
  require_distinct(args.species);
  require_free_folder(context);
  create_folder(context);
  const std::vector<ArticulatedBody> bodies = make_bodies(args, context);
  const std::vector<WrittenShape> written = write_shapes(args, context, bodies);
  std::string labels;
  nlohmann::json shapes = nlohmann::json::array();
  for (const WrittenShape& shape : written) {
    labels += shape.file + " " + shape.species + " " + std::to_string(shape.pose) + "\n";
    shapes.push_back({{"file", shape.file},
                      {"truth", fs::path(shape.file).replace_extension(".vts").string()},
                      {"species", shape.species},
                      {"pose", shape.pose},
                      {"vertices", shape.vertices},
                      {"faces", shape.faces}});
  }
  // Last the list of shapes: where it is, all it lists is there.
  const fs::path folder = context.output;
  context.write_result((folder / "symmetry.txt").string(), symmetry_table(bodies));
  context.write_result((folder / "pairs.txt").string(), pair_lines(args));
  context.write_result((folder / "labels.txt").string(), labels);
  context.answer({{"folder", context.output},
                  {"shapes", shapes},
                  {"labels", "labels.txt"},
                  {"pairs", "pairs.txt"},
                  {"symmetry", "symmetry.txt"}},
                 "wrote " + std::to_string(written.size()) + " shapes to " +
                     escape_control(context.output) + "\n");
}

void add_creatures(CLI::App& make, Context& context) {
  auto args = std::make_shared<CreatureArguments>();
  CLI::App& command = *make.add_subcommand("articulated", "Creatures in several poses, with truth");
  command.add_option("--species", args->species, "which creatures, comma-separated")
      ->delimiter(',')
      ->capture_default_str();
  command.add_option("--poses", args->poses, "poses of each; pose 0 is the creature at rest")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_option("--resolution", args->options.vertices, "about how many vertices a shape has")
      ->check(CLI::Range(1000, 50000))
      ->capture_default_str();
  command.add_option("--seed", args->options.seed, "of poses, proportions and vertex order")
      ->capture_default_str();
  command
      .add_option("--variation", args->options.variation,
                  "share by which the seed may change proportions")
      ->check(number_between(0.0, 0.25))
      ->capture_default_str();
  command.add_flag("!--no-shuffle", args->options.shuffle,
                   "keep one vertex order over the poses of a species");
  command.add_option("--format", args->format, "of the meshes: ply, off or obj")
      ->check(CLI::IsMember({"ply", "off", "obj"}))
      ->capture_default_str();
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.get_option("--output")->required()->description("folder for the files");
  command.footer(
      "Writes SPECIESpose meshes and their truth (.vts: line i = vertex of the mesh for template\n"
      "vertex i, from 1), labels.txt, pairs.txt and symmetry.txt (left-right, template vertices).\n"
      "Example:\n  timbre dataset make articulated -o creatures --species horse,dog --poses 4");
  command.callback([args, &context] { make_creatures(*args, context); });
}

// A surface of one parameter: about how many vertices.
struct AnalyticKind {
  const char* name;
  const char* about;
  TriangleMesh (*make)(int vertices);
};

int root(double value) { return std::max(1, static_cast<int>(std::lround(std::sqrt(value)))); }

constexpr std::array kAnalytic = {
    AnalyticKind{"sphere", "Unit sphere", [](int n) { return make_sphere(root((n - 2) / 10.0)); }},
    AnalyticKind{"torus", "Torus of revolution, radii 1 and 0.4",
                 [](int n) {
                   const int tube = std::max(3, root(0.4 * n));
                   return make_torus(1.0, 0.4, std::max(3, n / tube), tube);
                 }},
    AnalyticKind{"disk", "Unit disk", [](int n) { return make_disk(root(n / 3.0)); }},
    AnalyticKind{"rectangle", "Rectangle [0, 2] x [0, 1]",
                 [](int n) {
                   const int cells = root(n / 2.0);
                   return make_rectangle(2.0, 1.0, 2 * cells, cells);
                 }},
    AnalyticKind{"ellipsoid", "Ellipsoid with semi-axes 1, 0.8, 0.6",
                 [](int n) { return make_ellipsoid(1.0, 0.8, 0.6, root((n - 2) / 10.0)); }},
};

struct AnalyticArguments {
  int resolution = 2500;
  std::string format;
};

// --format, else the ending, else (for standard output) PLY.
MeshFormat format_for(const AnalyticArguments& args, const std::string& path) {
  if (!args.format.empty()) return formats().at(args.format);
  if (path == "-") return MeshFormat::ply;
  const std::string ending = fs::path(path).extension().string();
  const auto known = formats().find(ending.empty() ? "" : ending.substr(1));
  if (known != formats().end()) return known->second;
  throw Error(ErrorKind::bad_request, path, "", "ending is none of .ply, .off, .obj; see --format");
}

void make_analytic(const AnalyticKind& kind, const AnalyticArguments& args,
                   const Context& context) {
  const MeshFormat format = format_for(args, context.output);
  context.require_output();
  const TriangleMesh mesh = kind.make(args.resolution);
  context.write_result(context.output, to_mesh_bytes(mesh, format));
  context.answer({{"file", context.output},
                  {"kind", kind.name},
                  {"vertices", mesh.vertices.rows()},
                  {"faces", mesh.faces.rows()}},
                 context.output == "-" ? "" : "wrote " + escape_control(context.output) + "\n");
}

void add_analytic(CLI::App& make, const AnalyticKind& kind, Context& context) {
  auto args = std::make_shared<AnalyticArguments>();
  CLI::App& command = *make.add_subcommand(kind.name, kind.about);
  command.add_option("--resolution", args->resolution, "about how many vertices")
      ->check(CLI::Range(12, 10000000))
      ->capture_default_str();
  command.add_option("--format", args->format, "ply, off or obj; default: the file's ending")
      ->check(CLI::IsMember({"ply", "off", "obj"}));
  add_common_options(command, context, true);
  command.get_option("--output")->required();
  command.footer("Example:\n  timbre dataset make " + std::string(kind.name) + " -o " +
                 std::string(kind.name) + ".ply --resolution 10000");
  command.callback([args, &kind, &context] { make_analytic(kind, *args, context); });
}

}  // namespace

void add_dataset(CLI::App& timbre, Context& context) {
  CLI::App& dataset = *timbre.add_subcommand("dataset", "Shapes to try things on");
  dataset.require_subcommand(1);
  CLI::App& make = *dataset.add_subcommand("make", "Makes shapes from nothing");
  make.require_subcommand(1);
  add_creatures(make, context);
  for (const AnalyticKind& kind : kAnalytic) add_analytic(make, kind, context);
}

}  // namespace timbre::cli
