#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "timbre/analysis/operators/operator.h"
#include "timbre/cli/render/camera.h"

namespace timbre::cli {

// Options that mean the same in every command.

/// What words stand for where the value may also be absent.
template <typename Value>
struct WordMeaning {
  using Type = Value;
};
template <typename Value>
struct WordMeaning<std::optional<Value>> {
  using Type = Value;
};

/// An option whose values are words; without it `value` stays what it is, and --help shows that.
/// (CLI11's own transformers print the numbers behind the words, those of one byte as
/// characters.)
template <typename Value>
CLI::Option* add_word_option(CLI::App& command, const std::string& name, Value& value,
                             const std::map<std::string, typename WordMeaning<Value>::Type>& words,
                             const std::string& about) {
  std::vector<std::string> known;
  std::string standard;
  for (const auto& [word, meaning] : words) {
    known.push_back(word);
    if (meaning == value) standard = word;
  }
  return command
      .add_option_function<std::string>(
          name, [&value, words](const std::string& word) { value = words.at(word); }, about)
      ->check(CLI::IsMember(known))
      ->default_str(standard);
}

/// --operator and --mass.
void add_operator_options(CLI::App& command, OperatorOptions& options);

/// --boundary.
void add_boundary_option(CLI::App& command, OperatorOptions& options);

/// --up: which axis of the meshes points up in pictures.
void add_up_option(CLI::App& command, UpAxis& up);

/// A number in [low, high], which messages show as people write them.
[[nodiscard]] CLI::Validator number_between(double low, double high);

/// What the ending of an output name asks for: "npz", "npy", "mat" or "txt".
/// @throws Error  bad_request for another ending; "-" is text
[[nodiscard]] std::string array_format(const std::string& path);

}  // namespace timbre::cli
