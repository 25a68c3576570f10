#include "timbre/cli/version.h"

#include "timbre/cli/build_version.h"

namespace timbre::cli {

std::string version_number() { return kBuildVersion; }

std::string version_text() {
  std::string text = std::string("timbre ") + kBuildVersion;
  if (kBuildCommit[0] != '\0') text += std::string(" (") + kBuildCommit + ")";
  text += "\nlicence: MIT";
  if (kBuildWithCholmod) {
    text += "; this build links CHOLMOD's supernodal module, so the whole is under the GPL";
  }
  text += std::string("\nfactorisation: ") + (kBuildWithCholmod ? "CHOLMOD, Eigen" : "Eigen");
  return text;
}

}  // namespace timbre::cli
