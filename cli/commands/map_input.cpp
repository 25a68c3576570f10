#include "timbre/cli/commands/map_input.h"

#include "timbre/analysis/core/number_text.h"

namespace timbre::cli {

MatchSurface prepare_for_matching(const Context& context, const std::string& path,
                                  const TriangleMesh& mesh, int count) {
  MatchSurface surface = for_file(path, [&] {
    return prepare_surface(
        mesh, {.eigenpairs = count, .threads = context.threads, .progress = context.progress()});
  });
  if (surface.component_share < 0.999) {
    context.note(path + ": only the largest component, " +
                 to_text(100.0 * surface.component_share, 1) + " % of the area, is used");
  }
  return surface;
}

MatchSurface load_surface(const Context& context, const std::string& path, int count) {
  return prepare_for_matching(context, path, load_mesh(context, path).mesh, count);
}

}  // namespace timbre::cli
