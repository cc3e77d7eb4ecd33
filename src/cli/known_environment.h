// SPDX-License-Identifier: Apache-2.0
// cli/known_environment.h: what the program keeps of the environment that it is started in.
#pragma once

namespace nacre {

// Removes all variables from an environment but those that the program or those that it starts
// (gnuplot, a browser) need: where programs, libraries, fonts and a display are, who the user is,
// and the language and time zone, if those name no file of anybody's. The libraries below it read
// hundreds of others, and some of them name code to load: OIIO_LIBRARY_PATH, INTEL_LIBITTNOTIFY64
// (oneTBB), GCONV_PATH (glibc), LIBHEIF_PLUGIN_PATH, OPENSSL_CONF, ... The array is changed in
// place, and nothing allocated: no library, the C library included, need have been initialised.
void KeepKnownEnvironment(char** environment);

}  // namespace nacre
