#include <map>
#include <memory>
#include <string>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/commands/dataset.h"
#include "timbre/datasets/truth.h"

namespace timbre::cli {
namespace {

const char* to_prose(SetLayout layout) {
  switch (layout) {
    case SetLayout::listed:
      return "labels from a list in the folder";
    case SetLayout::cla:
      return "classes from a .cla file";
    case SetLayout::faust:
      return "names as in FAUST (tr_reg_SSP: subject and pose)";
    case SetLayout::scape:
      return "names as in SCAPE (meshNNN)";
    case SetLayout::shrec:
      return "names as in SHREC 2007 (20 numbers a class)";
    case SetLayout::words:
      return "names as in TOSCA and SMAL (a word and a number)";
    default:
      return "names that tell no class";
  }
}

// As `read_shape_set` pairs them.
std::string who_pairs(const ShapeSet& set) {
  const bool all = set.layout == SetLayout::faust || set.layout == SetLayout::plain;
  return std::string(all ? "all shapes" : "shapes of one label") + ", in a fixed order";
}

void run(const std::string& folder, const Context& context) {
  const ShapeSet set = read_shape_set(folder);
  std::map<std::string, int> classes;
  nlohmann::json shapes = nlohmann::json::array();
  std::int64_t symmetric = 0;
  for (const SetShape& shape : set.shapes) {
    if (!shape.label.empty()) ++classes[shape.label];
    const bool has_symmetry = has_symmetry_truth(set, shape);
    symmetric += has_symmetry ? 1 : 0;
    shapes.push_back(
        {{"file", shape.name},
         {"label", shape.label.empty() ? nlohmann::json() : nlohmann::json(shape.label)},
         {"truth", truth_form(set, shape)},
         {"symmetry", has_symmetry}});
  }
  std::string text = escape_control(folder) + ": " + std::to_string(set.shapes.size()) +
                     " shapes, " + to_prose(set.layout) + "\n";
  for (const auto& [label, count] : classes) {
    text += "  " + escape_control(label) + ": " + std::to_string(count) + "\n";
  }
  text += "pairs: " + std::to_string(set.pairs.size()) +
          (set.pairs_listed ? " listed in pairs.txt\n" : " made of " + who_pairs(set) + "\n");
  text += "symmetry known of " + std::to_string(symmetric) + "\n";
  nlohmann::json pairs = nlohmann::json::array();
  for (const auto& [source, target] : set.pairs) pairs.push_back({source, target});
  context.answer({{"folder", folder},
                  {"layout", to_word(set.layout)},
                  {"shapes", shapes},
                  {"classes", classes},
                  {"pairs", pairs},
                  {"pairs_listed", set.pairs_listed}},
                 text);
}

}  // namespace

void add_dataset_info(CLI::App& dataset, Context& context) {
  auto folder = std::make_shared<std::string>();
  CLI::App& command = *dataset.add_subcommand("info", "What a folder of shapes with truth holds");
  command.add_option("FOLDER", *folder, "folder of a public set, or one of our own")->required();
  add_common_options(command, context, false);
  command.footer(
      "Known: TOSCA, FAUST, SCAPE, SHREC 2007, 2010 and 2011, SMAL by their file names, and any\n"
      "folder with labels.txt or classes.txt (FILE LABEL), pairs.txt, symmetry.txt, and .vts or\n"
      ".map files beside the meshes or in corres/.\n"
      "Example:\n  timbre dataset info creatures/remeshed");
  command.callback([folder, &context] { run(*folder, context); });
}

}  // namespace timbre::cli
