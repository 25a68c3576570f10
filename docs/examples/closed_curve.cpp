// Section 1 of the course in numbers and pictures: closed_curve FOLDER writes
// curve_compression.svg and curve_smoothing.svg there.
#include <Eigen/Core>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>
#include <vector>

#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"
#include "timbre/analysis/core/output_file.h"
#include "timbre/analysis/filter/closed_curve.h"
#include "timbre/analysis/filter/reconstruction.h"
#include "timbre/analysis/filter/spectral_transform.h"

namespace {

using Eigen::Index;
using Eigen::MatrixX2d;

constexpr Index kPoints = 401;  // as the course's seahorse has

// A starfish with arms of unlike length, bent, and a rough skin.
MatrixX2d starfish() {
  MatrixX2d points(kPoints, 2);
  for (Index j = 0; j < kPoints; ++j) {
    const double t = 2.0 * std::numbers::pi * static_cast<double>(j) / double(kPoints);
    const double arms = 0.42 * std::cos(5.0 * t) + 0.10 * std::cos(2.0 * t + 0.7);
    const double skin =
        0.035 * std::sin(41.0 * t) * (1.0 + std::sin(7.0 * t)) + 0.02 * std::cos(97.0 * t + 1.0);
    const double r = 1.0 + arms + skin;
    const double bent = t + 0.25 * r * r * std::sin(t + 0.4);
    points.row(j) << r * std::cos(bent), r * std::sin(bent);
  }
  return points;
}

struct Panel {
  MatrixX2d points;
  std::string caption;
};

// Side by side, each curve filling its own square: what is seen is the shape.
std::string to_svg(const std::vector<Panel>& panels) {
  constexpr double kSide = 150.0;
  constexpr double kCaption = 22.0;
  const auto number = [](double value) { return timbre::to_text(value, 1); };
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" +
                    number(kSide * static_cast<double>(panels.size())) + "\" height=\"" +
                    number(kSide + kCaption) + "\">\n";
  double left = 0.0;
  for (const Panel& panel : panels) {
    const Eigen::RowVector2d low = panel.points.colwise().minCoeff();
    const Eigen::RowVector2d high = panel.points.colwise().maxCoeff();
    const double scale = 0.9 * kSide / (high - low).maxCoeff();
    const Eigen::RowVector2d middle = 0.5 * (low + high);
    svg += "<polygon fill=\"#dbe9f6\" stroke=\"#08519c\" stroke-width=\"1.2\" points=\"";
    for (const auto& point : panel.points.rowwise()) {
      svg += number(left + 0.5 * kSide + scale * (point[0] - middle[0])) + "," +
             number(0.5 * kSide - scale * (point[1] - middle[1])) + " ";
    }
    svg += "\"/>\n<text x=\"" + number(left + 0.5 * kSide) + "\" y=\"" + number(kSide + 14.0) +
           "\" text-anchor=\"middle\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#666\">" +
           panel.caption + "</text>\n";
    left += kSide;
  }
  return svg + "</svg>\n";
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  const std::string folder = std::string(argv[1]) + "/";
  const MatrixX2d points = starfish();

  const timbre::Spectrum basis = timbre::closed_curve_spectrum(kPoints, kPoints);
  const timbre::SparseMatrix mass = timbre::closed_curve_operator(kPoints).mass;
  const Eigen::MatrixXd coefficients = timbre::forward_transform(basis, mass, points);
  const timbre::Reconstruction parts = timbre::analyse_reconstruction(basis, mass, points);
  std::vector<Panel> compressed;
  for (const Index k : {3, 11, 31, 101, 201}) {
    const std::string error = timbre::to_text(100.0 * parts.errors[k], 2) + " %";
    std::cout << k << " coefficients: error " << error << '\n';
    compressed.push_back({timbre::inverse_transform(basis, coefficients.topRows(k)),
                          "k = " + std::to_string(k) + ": " + error});
  }
  compressed.push_back({points, "n = " + std::to_string(kPoints)});
  timbre::write_file(folder + "curve_compression.svg", to_svg(compressed), true);

  std::vector<Panel> smoothed;
  for (const int steps : {0, 10, 100, 1000, 10000}) {
    smoothed.push_back(
        {timbre::smooth_closed_curve(points, 0.5, steps), "m = " + std::to_string(steps)});
  }
  smoothed.push_back({timbre::inverse_transform(basis, coefficients.topRows(3)), "limit"});
  timbre::write_file(folder + "curve_smoothing.svg", to_svg(smoothed), true);
} catch (const timbre::Error& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
