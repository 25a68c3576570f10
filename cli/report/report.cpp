#include "timbre/cli/report/report.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "timbre/analysis/core/error.h"
#include "timbre/cli/report/material.h"
#include "timbre/cli/report/page.h"

namespace timbre::cli {
namespace {

std::vector<ShapeClass> classes_of(const std::vector<ShapeInfo>& shapes) {
  std::vector<ShapeClass> classes;
  for (const ShapeInfo& shape : shapes) {
    auto entry = std::find_if(classes.begin(), classes.end(),
                              [&](const ShapeClass& one) { return one.label == shape.label; });
    if (entry == classes.end()) entry = classes.insert(entry, {shape.label, {}});
    entry->shapes.push_back(shape);
  }
  return classes;
}

std::optional<EvaluationLog> log_of(const std::string& path, const std::string& kind) {
  if (path.empty()) return std::nullopt;
  EvaluationLog log = read_evaluation_log(path);
  if (log.kind == kind) return log;
  throw Error(ErrorKind::bad_input, path, "kind",
              "is '" + log.kind + "'; a log of kind '" + kind + "' is needed");
}

Material gather(const ReportInputs& inputs) {
  Store store = Store::open(inputs.database);
  std::vector<ShapeInfo> shapes = store.list();
  if (shapes.empty()) throw Error(ErrorKind::bad_input, inputs.database, "", "holds no shapes");
  std::vector<ShapeClass> classes = classes_of(shapes);
  const bool has_labels = classes.size() > 1 || !classes.front().label.empty();
  std::optional<ShapeSet> set;
  if (!inputs.set.empty()) set = read_shape_set(inputs.set);
  return {inputs,
          std::move(store),
          std::move(shapes),
          std::move(classes),
          has_labels,
          std::move(set),
          log_of(inputs.matches, "map"),
          log_of(inputs.symmetries, "sym"),
          PictureMaker(inputs.pictures)};
}

std::string title_of(const ReportInputs& inputs) {
  if (!inputs.title.empty()) return inputs.title;
  return "The sound of " + std::filesystem::path(inputs.database).stem().string();
}

}  // namespace

TriangleMesh mesh_of(const Material& material, const std::string& file) {
  if (material.set) return read_set_mesh(find_shape(*material.set, file).file).mesh;
  if (material.store.find(shape_stem(file))) return material.store.mesh(shape_stem(file));
  throw Error(ErrorKind::bad_input, material.store.location(), "",
              "has no shape '" + shape_stem(file) + "', which a log names; give --set FOLDER");
}

std::vector<ShapeInfo> first_shapes(const Material& material, std::size_t count) {
  std::vector<ShapeInfo> shapes = material.shapes;
  if (shapes.size() > count)
    shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(count), shapes.end());
  return shapes;
}

ReportPage make_report(const ReportInputs& inputs) {
  Material material = gather(inputs);
  const std::string title = title_of(inputs);
  ReportPage made;
  std::string content = header_section(material, title);
  const auto add = [&](const char* name, const std::string& html) {
    if (html.empty()) return;
    made.sections.emplace_back(name);
    content += html;
  };
  add("gallery", gallery_section(material));
  add("spectra", spectra_section(material));
  add("functions", functions_section(material));
  add("maps", maps_section(material));
  add("symmetry", symmetry_section(material));
  add("figures", figures_section(material));
  add("making", making_section(material));
  const bool has_viewer = content.find("<div class=\"viewer\"") != std::string::npos;
  made.html = page(title, content + "</main>\n", has_viewer);
  return made;
}

}  // namespace timbre::cli
