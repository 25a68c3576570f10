#include "timbre/cli/array_input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "timbre/analysis/core/array_file.h"
#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"
#include "timbre/analysis/core/number_text.h"

namespace timbre::cli {
namespace {

constexpr std::string_view kBlanks = " \t\r";

Error line_error(std::size_t line, const std::string& cause) {
  return {ErrorKind::bad_input, "", "line " + std::to_string(line), cause};
}

// Appends the numbers of a line; how many there were.
std::size_t take_numbers(std::string_view line, std::size_t number, std::vector<double>& values) {
  std::size_t count = 0;
  for (;;) {
    line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
    if (line.empty()) return count;
    const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
    const std::optional<double> value = parse_double(word);
    if (!value) {
      throw line_error(number, "'" + std::string(word.substr(0, 40)) + "' is not a number");
    }
    values.push_back(*value);
    ++count;
    line.remove_prefix(word.size());
  }
}

Eigen::MatrixXd parse_table(std::string_view text) {
  std::vector<double> values;
  std::size_t columns = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::size_t count = take_numbers(text.substr(0, end), number, values);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (count == 0) continue;
    if (columns == 0) columns = count;
    if (count != columns) {
      throw line_error(number, "has " + std::to_string(count) + " numbers, lines before have " +
                                   std::to_string(columns));
    }
  }
  if (values.empty()) throw Error(ErrorKind::bad_input, "", "", "holds no numbers");
  using Table = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const Table>(values.data(), static_cast<Eigen::Index>(values.size() / columns),
                                 static_cast<Eigen::Index>(columns));
}

}  // namespace

Eigen::MatrixXd read_table(const Context& context, const std::string& path) {
  const std::string bytes =
      read_bytes(path, {.size_limit = context.read.size_limit, .stop = interrupted});
  return for_file(path, [&] {
    if (bytes.starts_with("PK")) {
      throw Error(ErrorKind::bad_input, "", "",
                  "is an archive; a single array (.npy) or text (.txt) is needed");
    }
    return bytes.starts_with("\x93NUMPY") ? from_npy(bytes) : parse_table(bytes);
  });
}

std::vector<std::int32_t> read_point_map(const Context& context, const std::string& path) {
  const Eigen::MatrixXd table = read_table(context, path);
  return for_file(path, [&] {
    if (table.cols() != 1) {
      throw Error(ErrorKind::bad_input, "", "",
                  "has " + std::to_string(table.cols()) + " columns; a map has one");
    }
    std::vector<std::int32_t> map;
    map.reserve(static_cast<std::size_t>(table.rows()));
    for (Eigen::Index i = 0; i < table.rows(); ++i) {
      const double entry = table(i, 0);
      if (!(entry >= -1.0 && entry <= std::numeric_limits<std::int32_t>::max()) ||
          entry != std::floor(entry)) {
        throw Error(ErrorKind::bad_input, "", "entry " + std::to_string(i),
                    to_text(entry) + " is no vertex number");
      }
      map.push_back(static_cast<std::int32_t>(entry));
    }
    return map;
  });
}

}  // namespace timbre::cli
