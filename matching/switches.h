#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace timbre {

enum class SwitchKind : std::uint8_t {
  flipped,    ///< the same function, of opposite sign
  exchanged,  ///< another function of the target
  mixed,      ///< several functions that only together correspond
};

/// How low eigenfunctions of one shape appear on the other. Numbers count from 0, the
/// constant function.
struct Switch {
  SwitchKind kind = SwitchKind::flipped;
  std::vector<int> source;
  std::vector<int> target;
};

/// Reads the first `count` functions of the source off a functional map: an entry above 0.7
/// in size is a pair, connected entries above 0.3 are a mixture. Functions that simply
/// correspond are not listed; a mixture without target has no counterpart.
/// @param C  F(B) -> F(A): row i tells what function i of the source is made of
/// @see Levy and Zhang 2009, figure 22
[[nodiscard]] std::vector<Switch> find_switches(const Eigen::MatrixXd& C, int count);

[[nodiscard]] const char* to_word(SwitchKind kind);

}  // namespace timbre
