#include "timbre/cli/render/render.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/array_input.h"
#include "timbre/cli/command.h"
#include "timbre/cli/commands/render_values.h"
#include "timbre/cli/options.h"
#include "timbre/cli/render/transfer.h"

namespace timbre::cli {
namespace {

struct Arguments {
  std::string mesh;
  std::string size = "512";
  std::vector<std::string> views = {"three-quarter"};
  View free_view;
  bool free = false;  ///< --azimuth or --elevation instead of --view
  std::string background = "transparent";
  RenderOptions options;

  RenderValues values;
  std::string map, onto;
  std::vector<std::int32_t> markers;
};

constexpr int kLargestSide = 4096;

const std::map<std::string, View>& named_views() {
  static const std::map<std::string, View> kViews = {
      {"front", {0.0, 0.0}},          {"right", {90.0, 0.0}}, {"back", {180.0, 0.0}},
      {"left", {270.0, 0.0}},         {"top", {0.0, 90.0}},   {"bottom", {0.0, -90.0}},
      {"three-quarter", {38.0, 20.0}}};
  return kViews;
}

Error bad_option(const std::string& option, const std::string& cause) {
  return {ErrorKind::bad_request, "", option, cause};
}

void set_size(const std::string& text, RenderOptions& options) {
  const std::size_t cross = text.find('x');
  const auto width = parse_integer(text.substr(0, cross));
  const auto height = cross == std::string::npos ? width : parse_integer(text.substr(cross + 1));
  for (const auto side : {width, height}) {
    if (side && *side >= 16 && *side <= kLargestSide) continue;
    throw bad_option("size", "'" + text + "' is no side or WIDTHxHEIGHT, in pixels from 16 to " +
                                 std::to_string(kLargestSide));
  }
  options.width = static_cast<int>(*width);
  options.height = static_cast<int>(*height);
}

std::optional<Colour> parse_background(const std::string& text) {
  if (text == "transparent") return std::nullopt;
  if (text == "white") return Colour::Ones();
  if (text == "black") return Colour::Zero();
  const auto is_digit = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
  };
  if (text.size() != 7 || text[0] != '#' || !std::all_of(text.begin() + 1, text.end(), is_digit)) {
    throw bad_option("background", "'" + text + "' is none of transparent, white, black, #rrggbb");
  }
  Colour colour;
  for (int c = 0; c < 3; ++c) {
    colour(c) = static_cast<float>(
                    std::stoi(text.substr(1 + 2 * static_cast<std::size_t>(c), 2), nullptr, 16)) /
                255.0F;
  }
  return colour;
}

void require_picture_name(const std::string& path) {
  if (path == "-" || std::filesystem::path(path).extension() == ".png") return;
  throw Error(ErrorKind::bad_request, path, "output", "must end in .png; pictures are PNG files");
}

void add_markers(const std::vector<std::int32_t>& vertices, SurfaceLook& look) {
  const ColourTable colours = make_colour_table(ColourMapKind::categorical);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i] >= 0) look.markers.push_back({vertices[i], colours[i % colours.size()]});
  }
}

struct Drawing {
  std::vector<Image> images;
  int columns = 1;
  std::optional<ShownValues> values;
};

Drawing draw_one(const Arguments& args, const Context& context, const std::vector<View>& views) {
  const TriangleMesh mesh = load_mesh(context, args.mesh).mesh;
  SurfaceLook look{.mesh = mesh};
  Drawing drawing;
  for_file(args.mesh, [&] {
    drawing.values = show_values(args.values, context, look);
    add_markers(args.markers, look);
    drawing.images = render(look, views, args.options);
  });
  const int count = static_cast<int>(views.size());
  drawing.columns = count <= 4 ? count : (count + 1) / 2;
  return drawing;
}

Drawing draw_pair(const Arguments& args, const Context& context, const std::vector<View>& views) {
  const TriangleMesh source = load_mesh(context, args.mesh).mesh;
  const TriangleMesh target = load_mesh(context, args.onto).mesh;
  const std::vector<std::int32_t> map = read_point_map(context, args.map);
  SurfaceLook from{.mesh = source};
  SurfaceLook to{.mesh = target};
  for_file(args.map, [&] {
    const VertexColours colours = position_colours(source, args.options.up);
    to.colours = carry_colours(colours, map, target);
    from.colours = matched_colours(colours, map);
  });
  add_markers(args.markers, from);
  Drawing drawing;
  drawing.images = for_file(args.mesh, [&] { return render(from, views, args.options); });
  std::vector<std::int32_t> images_of_markers;
  for (const std::int32_t v : args.markers)
    images_of_markers.push_back(map[static_cast<std::size_t>(v)]);
  add_markers(images_of_markers, to);
  const std::vector<Image> right =
      for_file(args.onto, [&] { return render(to, views, args.options); });
  drawing.images.insert(drawing.images.end(), right.begin(), right.end());
  // One view: side by side. More: the target's row below the source's.
  drawing.columns = views.size() == 1 ? 2 : static_cast<int>(views.size());
  return drawing;
}

std::vector<View> chosen_views(const Arguments& args) {
  if (args.free) return {args.free_view};
  std::vector<View> views;
  for (const std::string& name : args.views) views.push_back(named_views().at(name));
  return views;
}

nlohmann::json to_json(const ShownValues& values) {
  return {{"about", values.about},
          {"colours", to_word(values.colours)},
          {"low", values.low},
          {"high", values.high}};
}

void run(Arguments& args, const Context& context) {
  set_size(args.size, args.options);
  args.options.background = parse_background(args.background);
  args.options.threads = context.threads;
  args.options.progress = context.progress();
  require_picture_name(context.output);
  context.require_output();
  const std::vector<View> views = chosen_views(args);
  const Drawing drawing =
      args.map.empty() ? draw_one(args, context, views) : draw_pair(args, context, views);
  const Image picture = tile(drawing.images, drawing.columns);
  context.write_result(context.output, to_png(picture));
  nlohmann::json seen = nlohmann::json::array();
  for (const View& view : views) {
    seen.push_back({{"azimuth", view.azimuth}, {"elevation", view.elevation}});
  }
  context.answer({{"mesh", args.mesh},
                  {"output", context.output},
                  {"width", picture.width},
                  {"height", picture.height},
                  {"views", seen},
                  {"values", drawing.values ? to_json(*drawing.values) : nlohmann::json()}},
                 context.output == "-" ? "" : "wrote " + escape_control(context.output) + "\n");
}

void add_camera_options(CLI::App& command, Arguments& args) {
  command.add_option("--size", args.size, "pixels of each view: a side, or WIDTHxHEIGHT")
      ->capture_default_str();
  CLI::Option* const view =
      command.add_option("--view", args.views,
                         "front, back, left, right, top, bottom or three-quarter; several, "
                         "comma-separated, are tiled in one picture");
  std::vector<std::string> names;
  for (const auto& [name, unused] : named_views()) names.push_back(name);
  view->delimiter(',')->capture_default_str()->check(CLI::IsMember(names));
  command
      .add_option("--azimuth", args.free_view.azimuth,
                  "degrees from the front towards the right side, instead of --view")
      ->check(number_between(-360.0, 360.0))
      ->excludes(view);
  command
      .add_option("--elevation", args.free_view.elevation,
                  "degrees above the horizon, instead of --view")
      ->check(number_between(-90.0, 90.0))
      ->excludes(view);
  add_up_option(command, args.options.up);
  command.add_option("--background", args.background, "transparent, white, black or #rrggbb")
      ->capture_default_str();
}

void add_map_options(CLI::App& command, Arguments& args) {
  CLI::Option* const map = command.add_option(
      "--map", args.map, "show a map to --onto: for each vertex a vertex there, -1 for none");
  CLI::Option* const onto = command.add_option("--onto", args.onto, "mesh that --map leads to");
  map->needs(onto);
  onto->needs(map);
  for (const char* other : {"--values", "--eigenfunction", "--signature"}) {
    map->excludes(command.get_option(other));
  }
}

}  // namespace

void add_render(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand("render", "Pictures of surfaces, without a display");
  command.add_option("MESH", args->mesh, "mesh file, or - for standard input")->required();
  add_camera_options(command, *args);
  add_value_options(command, args->values);
  add_map_options(command, *args);
  command.add_option("--markers", args->markers, "vertices to mark with balls, comma-separated")
      ->delimiter(',')
      ->check(CLI::Range(0, 2147483647));
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, true);
  command.get_option("--output")->required()->description("the PNG file; - for standard output");
  command.footer(
      "With --map the mesh is coloured by position, and the target takes the colours that the\n"
      "map brings: the mean where several arrive, that of neighbours for three rings (more on\n"
      "finer targets) where none does, grey beyond. Text from 'timbre match -o MAP.txt' fits.\n"
      "Example:\n  timbre render horse.ply -o horse.png --eigenfunction 5 --view front,left");
  command.callback([args, &command, &context] {
    args->free = command.count("--azimuth") + command.count("--elevation") > 0;
    run(*args, context);
  });
}

}  // namespace timbre::cli
