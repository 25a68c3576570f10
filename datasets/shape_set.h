#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "timbre/analysis/mesh/read_mesh.h"

namespace timbre {

/// How the meshes of a folder are named, and so what their names tell.
enum class SetLayout : std::uint8_t {
  listed,  ///< labels.txt or classes.txt names the files (`FILE LABEL ...`)
  cla,     ///< T0, T1, ... and a .cla file of classes (SHREC 2010, 2011)
  faust,   ///< tr_reg_SSP: subject SS, pose P
  scape,   ///< meshNNN: one subject
  shrec,   ///< 1 to 400: class c holds 20 c - 19 to 20 c (SHREC 2007 watertight)
  words,   ///< cat0, lion_2, ...: the word before the number (TOSCA, SMAL)
  plain,   ///< names tell nothing
};

[[nodiscard]] const char* to_word(SetLayout layout);

/// A shape of a set.
struct SetShape {
  std::string file;   ///< where its mesh lies; for TOSCA's text form the `.vert` file
  std::string name;   ///< base name of `file`, as lists have it
  std::string label;  ///< class or subject; empty if unknown
};

/// Pairs made for a set that lists none: of more, a fixed random choice.
inline constexpr std::int64_t kMostPairs = 200000;

/// A folder of shapes with truth, as public collections come.
struct ShapeSet {
  std::string folder;
  std::string truth_folder;  ///< where `.vts` and `.map` files lie
  SetLayout layout = SetLayout::plain;
  std::vector<SetShape> shapes;  ///< by name, numbers in order of size
  /// Base names, source and target: of pairs.txt; else all pairs of one label, or of all
  /// where names give no label, in a fixed random order, and no more than `kMostPairs`.
  std::vector<std::pair<std::string, std::string>> pairs;
  bool pairs_listed = false;                  ///< pairs.txt is there
  std::vector<std::string> symmetry_columns;  ///< names in the first line of symmetry.txt
};

/// A file's name without the ending of a mesh (`.ply`, `.ply.gz`): what `.vts` and `.map` files
/// and maps are named by.
[[nodiscard]] std::string shape_stem(const std::string& name);

/// Recognises the layout of a folder.
///
/// Meshes lie in the folder itself or in one of `off`, `shapes`, `meshes`, `registrations`
/// and `training/registrations` in it; truth beside them or in `corres`. Lists name a mesh by
/// its file or by its stem; names with blanks or commas cannot stand in them.
/// @throws Error  io if the folder cannot be read; bad_input if it holds no meshes, or for a
///                list that is malformed or names a file that is not there
/// @see Bronstein et al. 2008 (TOSCA), Bogo et al. 2014 (FAUST), Anguelov et al. 2005 (SCAPE),
///      Giorgi et al. 2007 (SHREC), Zuffi et al. 2017 (SMAL)
[[nodiscard]] ShapeSet read_shape_set(const std::string& folder);

/// @throws Error  bad_request if the set has no such shape
[[nodiscard]] const SetShape& find_shape(const ShapeSet& set, const std::string& name);

/// Reads a mesh of a set: what `read_mesh` reads, and TOSCA's text form, which is a list of
/// points NAME.vert and one of triangles NAME.tri, counted from 1.
/// @throws Error  as `read_mesh` does
[[nodiscard]] MeshFile read_set_mesh(const std::string& file, const ReadOptions& options = {});

}  // namespace timbre
