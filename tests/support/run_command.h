#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

#include "timbre/tests/support/temporary_folder.h"

namespace timbre {

struct Ran {
  int exit_code = -1;
  std::string out;
  std::string err;
};

/// Runs the timbre command. `arguments` pass through the shell.
inline Ran run_command(const std::string& arguments) {
  const TemporaryFolder folder;
  const std::string line = std::string("'") + TIMBRE_COMMAND + "' " + arguments + " >'" +
                           (folder / "out") + "' 2>'" + (folder / "err") + "'";
  const int status = std::system(line.c_str());  // NOLINT(concurrency-mt-unsafe)
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, file_content(folder / "out"),
          file_content(folder / "err")};
}

}  // namespace timbre
