#pragma once

#include <string>
#include <vector>

#include "timbre/cli/report/pictures.h"

namespace timbre::cli {

/// Where the material of a page lies; what is empty is left out.
struct ReportInputs {
  std::string database;
  std::string title;          ///< empty: made from the database's name
  std::string set;            ///< folder of shapes with truth
  std::string matches;        ///< log of `timbre eval match`
  std::string maps;           ///< folder of the maps it judged
  std::string symmetries;     ///< log of `timbre eval match --kind sym`
  std::string symmetry_maps;  ///< folder of these
  PictureOptions pictures;
};

struct ReportPage {
  std::string html;
  std::vector<std::string> sections;  ///< anchors, in order
};

/// One page that shows what is in a database and how well things work. It needs no other file
/// and no network. The same inputs give the same bytes.
/// @throws Error  io, bad_input or bad_request for inputs that cannot be read or do not fit
[[nodiscard]] ReportPage make_report(const ReportInputs& inputs);

}  // namespace timbre::cli
