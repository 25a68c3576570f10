# Writes HEADER from build_version.h.in, and leaves it alone if nothing changed.
set(COMMIT "")
# Not in a repository that merely holds an unpacked copy of the sources.
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} rev-parse --short=10 HEAD
    OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
  if(failed)
    set(COMMIT "")
  endif()
endif()
if(WITH_CHOLMOD)
  set(WITH_CHOLMOD true)
else()
  set(WITH_CHOLMOD false)
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/build_version.h.in ${HEADER} @ONLY)
