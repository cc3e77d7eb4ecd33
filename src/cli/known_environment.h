// SPDX-License-Identifier: Apache-2.0
// cli/known_environment.h: which environment variables the program keeps.
#pragma once

namespace nacre {

// Removes all variables from an environment except those that the program, or programs that it
// starts (gnuplot, a browser), need: where programs, libraries, fonts and a display are, who the
// user is, and the language and time zone, if these name no user's files. The libraries in use read
// hundreds of other variables, and some of these name code to load: OIIO_LIBRARY_PATH,
// INTEL_LIBITTNOTIFY64 (oneTBB), GCONV_PATH (glibc), LIBHEIF_PLUGIN_PATH, OPENSSL_CONF, ... The
// array is changed in place without allocating, so that no library, not even the C library, must
// have been initialised.
void KeepKnownEnvironment(char** environment);

}  // namespace nacre
