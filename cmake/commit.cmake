# Writes the commit that is built to FILE, and touches it only when that has changed. Run at build time:
#   cmake -DSOURCE=<tree> -DFILE=<header> -P commit.cmake
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=* OUTPUT_VARIABLE commit
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
set(text "#define TREAD_COMMIT \"${commit}\"\n")
if(EXISTS ${FILE})
  file(READ ${FILE} present)
endif()
if(NOT "${present}" STREQUAL "${text}")
  file(WRITE ${FILE} "${text}")
endif()
