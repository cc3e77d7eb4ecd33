# SPDX-License-Identifier: Apache-2.0
# Run at every build: writes OUTPUT with the project's version and commit, if they changed.
execute_process(COMMAND git -C ${SOURCE_DIR} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit unknown)
endif()
set(text "// Generated at build time.\n#include \"base/version.h\"\n\nnamespace nacre {\nconst char kVersion[] = \"${VERSION}\";\nconst char kCommit[] = \"${commit}\";\n}  // namespace nacre\n")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUTPUT} "${text}")
endif()
