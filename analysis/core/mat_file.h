#pragma once

#include <string>
#include <vector>

#include "timbre/analysis/core/array_file.h"

namespace timbre {

/// The bytes of a MATLAB file, version 5, not compressed: one variable for each array. Vectors are
/// columns. Indices count from 1 there, as all of MATLAB does, and 0 is none; where there are
/// some, the variable `index_base` says so. The same arrays give the same bytes.
///
/// @param arrays  of float64, int32 or text; names are letters, digits and _, a letter first, at
///                most 63; those with `is_index` are of int32
/// @throws Error  bad_request for another name or type, for data of another size than their shape,
///                and for an array of 2 GiB and more, which the format cannot hold
[[nodiscard]] std::string to_mat(const std::vector<NamedArray>& arrays);

}  // namespace timbre
