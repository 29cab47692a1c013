# SPDX-FileCopyrightText: The thalweg authors
# SPDX-License-Identifier: MIT
#
# What every target of the project has in common. Nothing here reaches a target of an embedding project.
include_guard()

# Scalar, SSE4, AVX2 and AVX-512 cover x86-64; a machine with SSSE3 and no more is not worth its share of every build.
set(THALWEG_DISABLED_TARGETS "HWY_SSSE3" CACHE STRING "SIMD targets of Highway that are not compiled")
set(THALWEG_KERNEL_OPTIONS "" CACHE STRING "Further compiler options of the files compiled once per SIMD target")
mark_as_advanced(THALWEG_DISABLED_TARGETS THALWEG_KERNEL_OPTIONS)

# thalweg_configure(<target>): language level, warnings and the arithmetic that makes results reproducible.
function(thalweg_configure target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(
    ${target} PROPERTIES CXX_EXTENSIONS OFF POSITION_INDEPENDENT_CODE ON COMPILE_WARNING_AS_ERROR ${THALWEG_WERROR})
  target_compile_definitions(${target} PRIVATE HWY_DISABLED_TARGETS=\(${THALWEG_DISABLED_TARGETS}\))
  target_compile_options(
    ${target}
    PRIVATE # The same bits on every target with fused multiply-add: the compiler must not choose where to fuse.
            -ffp-contract=off
            # sqrt and floor become instructions; nothing here reads errno.
            -fno-math-errno
            -Wall
            -Wextra
            -Wpedantic
            -Wshadow
            -Wconversion
            # What g++ means by -Wconversion.
            $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>
            # g++ 12 sees overlapping copies in concatenated std::strings (GCC bug 105329).
            $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
endfunction()

# thalweg_library(<target> <export name> <public header>...): a library of the package.
function(thalweg_library target export_name)
  add_library(${target})
  add_library(thalweg::${export_name} ALIAS ${target})
  thalweg_configure(${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${export_name} VERSION ${PROJECT_VERSION} SOVERSION
                                                                                                   ${PROJECT_VERSION})
  target_sources(${target} PUBLIC FILE_SET HEADERS BASE_DIRS include FILES ${ARGN})
  target_include_directories(${target} PRIVATE src)
endfunction()
