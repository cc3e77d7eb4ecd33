# SPDX-License-Identifier: Apache-2.0
# CMake toolchain for arm64 with Debian's cross compiler. NACRE_ARM64_ROOT is a folder with an arm64
# Debian's libraries; programs run there under QEMU's user mode. scripts/test_arm64 uses it.
if(NOT NACRE_ARM64_ROOT)
  message(FATAL_ERROR "NACRE_ARM64_ROOT is not set; scripts/test_arm64 makes that folder")
endif()
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES NACRE_ARM64_ROOT)

set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_SYSROOT ${NACRE_ARM64_ROOT})
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64 -L ${NACRE_ARM64_ROOT})

# Libraries and headers are arm64's, programs this machine's.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${NACRE_ARM64_ROOT})
set(ENV{PKG_CONFIG_LIBDIR}
  ${NACRE_ARM64_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${NACRE_ARM64_ROOT}/usr/share/pkgconfig)
