#include "timbre/index/query.h"

#include <memory>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/command.h"

namespace timbre::cli {
namespace {

struct Arguments {
  std::string database, mesh, stored;
  QueryOptions options;
};

QueryAnswer ask(const Arguments& args, const Context& context) {
  if (args.mesh.empty() == args.stored.empty()) {
    throw Error(ErrorKind::bad_request, "", "query", "needs one of MESH and --stored NAME");
  }
  // Of the request, not of the mesh.
  (void)find_channel(args.options.channel);
  const Store store = Store::open(args.database);
  if (!args.stored.empty()) return query_stored(store, args.stored, args.options);
  const MeshFile file = load_mesh(context, args.mesh);
  return for_file(args.mesh, [&] { return query_mesh(store, file.mesh, args.options); });
}

void show(const Arguments& args, const QueryAnswer& answer, const Context& context) {
  nlohmann::json results = nlohmann::json::array();
  std::string text = "rank\tdistance\tname\tlabel\n";
  for (const QueryResult& result : answer.results) {
    nlohmann::json channels = nlohmann::json::object();
    for (const auto& [channel, distance] : result.channels) channels[channel] = distance;
    results.push_back(
        {{"rank", result.rank},
         {"name", result.name},
         {"label", result.label.empty() ? nlohmann::json() : nlohmann::json(result.label)},
         {"distance", result.distance},
         {"score", result.score ? nlohmann::json(*result.score) : nlohmann::json()},
         {"channels", channels}});
    text += std::to_string(result.rank) + '\t' + to_short_text(result.distance) + '\t' +
            result.name + '\t' + result.label + '\n';
  }
  const bool exact = answer.recall >= 1.0;
  if (!exact) context.note("approximate: recall of the first ten " + to_text(answer.recall));
  context.answer({{"results", results},
                  {"channel", args.options.channel},
                  {"shapes", answer.shapes},
                  {"compared", answer.compared},
                  {"recall", answer.recall}},
                 text);
}

}  // namespace

void add_query(CLI::App& timbre, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *timbre.add_subcommand("query", "The stored shapes most like a mesh");
  command.add_option("DB", args->database, "the database")->required();
  command.add_option("MESH", args->mesh, "mesh file, or - for standard input");
  command.add_option("--stored", args->stored, "a stored shape instead; it is no answer itself");
  command.add_option("-n,--number", args->options.count, "answers wanted; 0: all")
      ->capture_default_str()
      ->check(CLI::Range(std::int64_t{0}, std::int64_t{1000000000}));
  command.add_option("--channel", args->options.channel, "descriptor to compare by")
      ->capture_default_str();
  command.add_flag("--exact", args->options.exact, "compare with every shape");
  add_read_options(command, context);
  add_threads_option(command, context);
  add_common_options(command, context, false);
  command.footer(
      "Text columns are parted by tabs; --json has all digits.\n"
      "Example:\n  timbre query shapes.timbre new.ply -n 5");
  command.callback([args, &context] {
    args->options.progress = context.progress();
    args->options.threads = context.threads;
    args->options.note = [&context](const std::string& line) { context.note(line); };
    show(*args, ask(*args, context), context);
  });
}

}  // namespace timbre::cli
