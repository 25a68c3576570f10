#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/operators/operator.h"

namespace timbre::cli {

/// An option whose values are words; `target` may be an enumerator or an optional one.
template <typename Kind, typename Target>
CLI::Option* add_word_option(CLI::App& command, const std::string& flag, Target& target,
                             const std::vector<std::pair<std::string, Kind>>& words,
                             const std::string& help) {
  std::vector<std::string> names;
  for (const auto& word : words) names.push_back(word.first);
  return command
      .add_option_function<std::string>(
          flag,
          [&target, words](const std::string& given) {
            for (const auto& [word, kind] : words) {
              if (word == given) target = kind;
            }
          },
          help)
      ->check(CLI::IsMember(names));
}

/// --operator
template <typename Target>
CLI::Option* add_operator_option(CLI::App& command, Target& target) {
  return add_word_option<OperatorKind>(command, "--operator", target,
                                       {{to_word(OperatorKind::cotan), OperatorKind::cotan}},
                                       "Laplacian (default cotan)");
}

/// --mass
template <typename Target>
CLI::Option* add_mass_option(CLI::App& command, Target& target) {
  return add_word_option<MassKind>(command, "--mass", target,
                                   {{to_word(MassKind::lumped), MassKind::lumped},
                                    {to_word(MassKind::consistent), MassKind::consistent}},
                                   "mass matrix (default lumped)");
}

}  // namespace timbre::cli
