#include "timbre/cli/report/evaluation_log.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/core/error.h"

namespace timbre::cli {
namespace {

using Json = nlohmann::json;

template <typename Value>
std::optional<Value> optional_of(const Json& result, const char* field) {
  const auto entry = result.find(field);
  if (entry == result.end() || entry->is_null()) return std::nullopt;
  return entry->get<Value>();
}

EvaluatedMap map_of(const Json& result) {
  EvaluatedMap map;
  map.source = result.at("source").get<std::string>();
  map.target = result.at("target").get<std::string>();
  map.error = optional_of<double>(result, "error");
  map.below5 = result.at("below5").get<double>();
  map.right = result.at("right").get<double>();
  map.found = result.at("found").get<bool>();
  map.verdict = result.value("verdict", "");
  map.flipped = optional_of<bool>(result, "flipped");
  map.seconds = optional_of<double>(result, "seconds");
  map.pck = result.at("pck").get<std::vector<double>>();
  return map;
}

EvaluationLog header_of(const Json& line) {
  EvaluationLog log;
  log.set = line.at("set").get<std::string>();
  log.kind = line.at("kind").get<std::string>();
  log.method = optional_of<std::string>(line, "method").value_or("");
  log.maps_folder = optional_of<std::string>(line, "maps").value_or("");
  log.geodesic = line.at("geodesic").get<std::string>();
  log.version = line.at("version").get<std::string>();
  log.count = line.at("count").get<int>();
  log.samples = line.at("samples").get<int>();
  return log;
}

}  // namespace

EvaluationLog read_evaluation_log(const std::string& path) {
  const std::string text = read_bytes(path);
  EvaluationLog log;
  std::map<std::string, std::size_t> known;
  int number = 0;
  std::size_t start = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', start)) {
    ++number;
    try {
      const Json line = Json::parse(std::string_view(text).substr(start, end - start));
      if (number == 1) {
        log = header_of(line);
      } else {
        // A result that was appended again stands for the one before.
        const auto [entry, is_new] =
            known.try_emplace(line.at("key").get<std::string>(), log.maps.size());
        if (is_new) log.maps.emplace_back();
        log.maps[entry->second] = map_of(line.at("result"));
      }
    } catch (const Json::exception&) {
      throw Error(ErrorKind::bad_input, path, "line " + std::to_string(number),
                  number == 1 ? "does not begin a log of 'timbre eval match SET -o FILE'"
                              : "is no result of 'timbre eval match'");
    }
    start = end + 1;
  }
  if (number == 0) throw Error(ErrorKind::bad_input, path, "", "is no log; it holds no line");
  return log;
}

}  // namespace timbre::cli
