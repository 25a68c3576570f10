#include <algorithm>
#include <array>
#include <bit>

#include "timbre/analysis/core/byte_source.h"
#include "timbre/analysis/mesh/detail/formats.h"

namespace timbre::detail {
namespace {

constexpr std::uint64_t kStlHeader = 84;
constexpr std::uint64_t kStlFacet = 50;

constexpr std::array<std::string_view, 11> kObjKeywords = {"v", "vn", "vt", "vp",     "f",     "g",
                                                           "o", "s",  "mg", "usemtl", "mtllib"};

[[noreturn]] void refuse(const std::string& place, const std::string& cause) {
  throw Error(ErrorKind::bad_input, "", place, cause);
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

std::uint32_t stl_facets(std::string_view head) {
  Cursor cursor(head);
  cursor.take(kStlHeader - 4);
  return cursor.value<std::uint32_t>(std::endian::little);
}

// The declared count fits the size, with less than one facet left over.
bool fits_stl(std::string_view head, std::uint64_t size) {
  if (head.size() < kStlHeader) return false;
  const std::uint64_t expected = kStlHeader + kStlFacet * stl_facets(head);
  return size >= expected && size - expected < kStlFacet;
}

void require_stl_size(std::string_view head, std::uint64_t size) {
  if (size < kStlHeader) refuse("end of file", "truncated: a binary STL has at least 84 bytes");
  if (fits_stl(head, size)) return;
  refuse("byte 80", std::to_string(stl_facets(head)) +
                        " facets are declared, the file has room for " +
                        std::to_string((size - kStlHeader) / kStlFacet));
}

// [ST][C][N][4][n]OFF, off, or the keyword with the first count glued to it.
bool is_off_keyword(std::string_view word) {
  if (word == "off") return true;
  if (word.size() > 3 && word.starts_with("OFF")) {
    return word.find_first_not_of("0123456789", 3) == std::string_view::npos;
  }
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  }
  return word == "OFF";
}

// Files that are often saved under a mesh's name by mistake.
void refuse_known_mistakes(std::string_view first_word, std::string_view second_word) {
  const std::string word = lower(first_word);
  if (word.starts_with("<!doctype") || word.starts_with("<html") || word.starts_with("<?xml")) {
    refuse("line 1", "a web page or XML, not a mesh; download the file itself");
  }
  if (word == "version" && second_word.starts_with("https://git-lfs")) {
    refuse("line 1", "a Git LFS pointer, not the mesh itself; fetch it with 'git lfs pull'");
  }
  if (word.starts_with('{')) {
    refuse("line 1", "glTF or other JSON as text; save it as binary .glb");
  }
  if (is_gzip(first_word)) refuse("byte 0", "gzip data; it is unpacked when the name ends in .gz");
}

// One of the three magics; the two marks of UTF-16 have other second bytes.
bool is_freesurfer(std::string_view head) {
  return head.starts_with("\xff\xff\xfd") || head.starts_with("\xff\xff\xfe") ||
         head.starts_with("\xff\xff\xff");
}

bool is_ply(std::string_view head) {
  return head.starts_with("ply") && (head.size() == 3 || head.find_first_of(" \t\r\n") == 3);
}

// Text and NUL do not go together, but the header of a binary STL may say anything.
bool is_stl_header(std::string_view head, std::string_view first_word, std::string_view ending) {
  const bool has_nul = head.substr(0, kStlHeader).find('\0') != std::string_view::npos;
  return has_nul && (ending == ".stl" || lower(first_word) == "solid");
}

}  // namespace

std::optional<FileFormat> detect_format(std::string_view head, std::uint64_t size,
                                        std::string_view name) {
  if (size == 0) refuse("byte 0", "the file is empty");
  // Before all words, for an STL may begin with any. No text fits by accident: the count
  // it spells would be above 150 million.
  const bool stl = fits_stl(head, size);
  if (stl && stl_facets(head) > 0) return FileFormat::stl_binary;
  // A surface cut after 84 bytes looks like an STL of no facets.
  if (is_freesurfer(head)) return FileFormat::freesurfer_binary;
  if (stl && size == kStlHeader) return FileFormat::stl_binary;
  if (head.starts_with("glTF")) return FileFormat::glb;
  if (head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff")) {
    refuse("byte 0", "UTF-16 text; save it as UTF-8");
  }
  const bool whole = head.size() == size;
  const std::string ending = lower(name.substr(std::min(name.rfind('.'), name.size())));
  const std::string_view text = without_mark(head);
  if (is_ply(text)) return FileFormat::ply;
  if (text.starts_with("#!ascii")) return FileFormat::freesurfer_text;
  if (text.starts_with("# vtk DataFile Version")) return FileFormat::vtk;

  Cursor cursor(text);
  cursor.expect_text({.hash_comments = true});
  const bool has_word = cursor.seek_word();
  const std::string_view word = cursor.word();
  const bool is_cut = cursor.left() == 0 && !whole;  // perhaps inside the word
  refuse_known_mistakes(word, cursor.word());
  if (is_off_keyword(word) && !is_cut) {
    Cursor(head.substr(0, static_cast<std::size_t>(word.data() - head.data()))).refuse_nul();
    return FileFormat::off;
  }
  if (is_stl_header(head, word, ending)) {
    require_stl_size(head, size);
    return FileFormat::stl_binary;
  }
  Cursor(head).refuse_nul();
  if (is_cut) return std::nullopt;
  if (!has_word) refuse("end of file", "nothing but white space and comments");
  if (lower(word) == "solid") return FileFormat::stl_text;
  const bool is_obj =
      std::find(kObjKeywords.begin(), kObjKeywords.end(), word) != kObjKeywords.end();
  if (is_obj || ending == ".obj") return FileFormat::obj;
  if (ending == ".asc") return FileFormat::freesurfer_text;
  if (ending == ".stl") require_stl_size(head, size);
  refuse("line 1",
         "no known format; OFF, OBJ, PLY, STL, FreeSurfer, VTK and GLB are read, also with .gz");
}

std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

}  // namespace timbre::detail
