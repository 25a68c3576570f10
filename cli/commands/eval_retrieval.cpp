#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/cli/commands/eval.h"
#include "timbre/datasets/metrics.h"
#include "timbre/index/gallery.h"
#include "timbre/index/labels.h"

namespace timbre::cli {
namespace {

struct Arguments {
  std::string database, labels;
  std::string channel = kDefaultChannel;
  int label_column = 2;
};

nlohmann::json to_json(const RetrievalScores& scores) {
  return {{"map", scores.average_precision}, {"nn", scores.nearest},
          {"first_tier", scores.first_tier}, {"second_tier", scores.second_tier},
          {"e_measure", scores.e_measure},   {"dcg", scores.dcg},
          {"precision", scores.precision}};
}

std::string to_line(const std::string& what, const RetrievalScores& scores) {
  std::string line = what;
  for (const double value : {scores.average_precision, scores.nearest, scores.first_tier,
                             scores.second_tier, scores.e_measure, scores.dcg}) {
    line += '\t' + to_text(std::round(value * 1e4) / 1e4);
  }
  return line + '\n';
}

RetrievalReport evaluate(const Arguments& args) {
  const Gallery gallery = load_gallery(Store::open(args.database), find_channel(args.channel));
  const Labels labels = args.labels.empty() ? Labels() : Labels(args.labels, args.label_column);
  std::vector<std::string> classes;
  for (std::int64_t i = 0; i < gallery.size(); ++i) {
    const ShapeInfo& shape = gallery.shape(i);
    classes.push_back(args.labels.empty() ? shape.label : labels.of(shape.name));
  }
  return evaluate_retrieval(classes,
                            [&](Eigen::Index i) { return gallery.distances(gallery.vector(i)); });
}

void show(const RetrievalReport& report, const Arguments& args, Context& context) {
  nlohmann::json document = to_json(report.micro);
  document["macro"] = to_json(report.macro);
  document["classes"] = nlohmann::json::array();
  std::string text = "\tmAP\tNN\tFT\tST\tE\tDCG\n" + to_line("all queries", report.micro) +
                     to_line("mean of classes", report.macro);
  for (const ClassScores& one : report.classes) {
    nlohmann::json entry = to_json(one.mean);
    entry["label"] = one.label;
    entry["queries"] = one.queries;
    document["classes"].push_back(entry);
    text += to_line(escape_control(one.label), one.mean);
  }
  document["channel"] = args.channel;
  document["queries"] = report.queries;
  document["shapes"] = report.shapes;
  document["undefined"] = report.undefined;
  context.answer(document, text);
  if (report.undefined > 0) {
    context.complain(std::to_string(report.undefined) + " distances are not finite");
    context.exit_code = 1;
  }
}

}  // namespace

void add_eval_retrieval(CLI::App& eval, Context& context) {
  auto args = std::make_shared<Arguments>();
  CLI::App& command = *eval.add_subcommand(
      "retrieval", "Every stored shape as a query: does its class come first?");
  command.add_option("DB", args->database, "the database")->required();
  command.add_option("--channel", args->channel, "descriptor to compare by")->capture_default_str();
  command.add_option("--labels", args->labels, "FILE LABEL ... lines; default: stored labels");
  command.add_option("--label-column", args->label_column, "column of the label; FILE is 1")
      ->capture_default_str()
      ->check(CLI::Range(2, 1000));
  add_common_options(command, context, false);
  command.footer(
      "Leave-one-out; ties count against the ranking; shapes alone in their class are no\n"
      "queries. --json also has the precision at recalls 0.05, 0.1, ..., 1.\n"
      "Example:\n  timbre eval retrieval shapes.timbre --channel dna_log --json | jq .map");
  command.callback([args, &context] { show(evaluate(*args), *args, context); });
}

}  // namespace timbre::cli
