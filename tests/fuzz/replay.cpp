// Stands in for libFuzzer where there is none: puts stored inputs through a target, each line
// of an `.inputs` file (see inputs.py) and any other file as a whole.
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>

#include "timbre/tests/fuzz/target.h"

namespace {

// A buffer of exactly this size, so that a sanitizer sees each step beyond it.
void examine_alone(std::string_view input) {
  const auto buffer = std::make_unique<char[]>(input.size());
  input.copy(buffer.get(), input.size());
  timbre::fuzz::examine({buffer.get(), input.size()});
}

// Text with `\\`, `\n`, `\r`, `\t` and `\xNN`; nothing if it is written otherwise.
std::optional<std::string> unescaped(std::string_view line) {
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string bytes;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] != '\\') {
      bytes += line[i];
      continue;
    }
    if (++i == line.size()) return std::nullopt;
    if (line[i] == 'x' && i + 2 < line.size()) {
      const std::size_t high = kHex.find(line[i + 1]);
      const std::size_t low = kHex.find(line[i + 2]);
      if (high == kHex.npos || low == kHex.npos) return std::nullopt;
      bytes += static_cast<char>(16 * high + low);
      i += 2;
    } else if (const std::size_t letter = std::string_view("nrt\\").find(line[i]);
               letter != std::string_view::npos) {
      bytes += "\n\r\t\\"[letter];
    } else {
      return std::nullopt;
    }
  }
  return bytes;
}

// How many inputs there were; -1 if the file cannot be used.
int replay(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return -1;
  if (!path.ends_with(".inputs")) {
    examine_alone(std::string(std::istreambuf_iterator<char>(in), {}));
    return 1;
  }
  int count = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    const std::optional<std::string> input = unescaped(line);
    if (!input) return -1;
    examine_alone(*input);
    ++count;
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  examine_alone("");
  int count = 1;
  for (int i = 1; i < argc; ++i) {
    const int more = replay(argv[i]);
    if (more < 0) {
      std::cerr << argv[i] << ": cannot be read\n";
      return 1;
    }
    count += more;
  }
  std::cout << count << " inputs\n";
  return 0;
}
