#pragma once

namespace timbre::fuzz {

/// The format under test, a word of `detail::FileFormat`. One per program, so that what examines
/// them is compiled once.
extern const char* const tested_format;

}  // namespace timbre::fuzz
