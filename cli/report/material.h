#pragma once

#include <optional>
#include <string>
#include <vector>

#include "timbre/cli/report/evaluation_log.h"
#include "timbre/cli/report/report.h"
#include "timbre/datasets/shape_set.h"
#include "timbre/index/store.h"

namespace timbre::cli {

struct ShapeClass {
  std::string label;              ///< empty: the shapes without one
  std::vector<ShapeInfo> shapes;  ///< in the order of adding
};

/// What the sections of a page are made from.
struct Material {
  ReportInputs inputs;
  Store store;
  std::vector<ShapeInfo> shapes;    ///< in the order of adding
  std::vector<ShapeClass> classes;  ///< in the order of their first shapes
  bool has_labels = false;          ///< some shape has one
  std::optional<ShapeSet> set;
  std::optional<EvaluationLog> matches, symmetries;
  PictureMaker pictures;
};

/// The mesh that a log names: of the set if there is one, else of the database.
/// @throws Error  bad_input if neither has it
[[nodiscard]] TriangleMesh mesh_of(const Material& material, const std::string& file);

/// The first shapes of the database, at most `count`.
[[nodiscard]] std::vector<ShapeInfo> first_shapes(const Material& material, std::size_t count);

// The sections, in the order of the page; empty where there is nothing to show.
[[nodiscard]] std::string header_section(Material& material, const std::string& title);
[[nodiscard]] std::string gallery_section(Material& material);
[[nodiscard]] std::string spectra_section(const Material& material);
[[nodiscard]] std::string functions_section(Material& material);
[[nodiscard]] std::string maps_section(Material& material);
[[nodiscard]] std::string symmetry_section(Material& material);
[[nodiscard]] std::string figures_section(const Material& material);
[[nodiscard]] std::string making_section(const Material& material);

}  // namespace timbre::cli
