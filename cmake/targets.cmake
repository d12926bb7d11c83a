# Flags that every target of the project shares: warnings, which presets make errors, and one floating-point model in
# both host compilers.
add_library(tread_flags INTERFACE)
target_include_directories(tread_flags INTERFACE ${PROJECT_SOURCE_DIR}/src ${PROJECT_BINARY_DIR}/generated)
target_compile_definitions(tread_flags INTERFACE EIGEN_MAX_STATIC_ALIGN_BYTES=0
                                                 $<$<BOOL:${TREAD_WITH_CUDA}>:TREAD_WITH_CUDA>)
target_compile_options(
  tread_flags
  INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall
    -Wextra
    -Wshadow
    -Wconversion
    -ffp-contract=off
    -fno-math-errno
    -fno-trapping-math
    -march=${TREAD_CPU}
    -fopenmp>
    $<$<COMPILE_LANGUAGE:CUDA>:-diag-suppress=20012,20014
    -Xcompiler=-ffp-contract=off>)
target_link_options(tread_flags INTERFACE -fopenmp)
if(TREAD_SANITIZE)
  # GCC's manual: sanitizers bring false positives of maybe-uninitialized; here from libstdc++'s own <regex>.
  target_compile_options(
    tread_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${TREAD_SANITIZE} -fno-omit-frame-pointer
                          -fno-sanitize-recover=all
                          $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>>)
  target_link_options(tread_flags INTERFACE -fsanitize=${TREAD_SANITIZE} -rdynamic)
endif()

# tread_precompile(TARGET HEADERS...): these, and what all files read, are compiled once for the files of a target, unless they
# are few, as they are where a unity build joins them. A file of src that lacks an include is found by clang-tidy, for which
# ci/full precompiles nothing.
function(tread_precompile target)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "[.]cpp$")
  list(LENGTH sources files)
  if(files GREATER 4 AND NOT CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} PRIVATE <algorithm> <cmath> <string> <vector> <fmt/format.h> ${ARGN})
  endif()
endfunction()

# tread_optimise_less(TARGET): for what takes no time in a run; it compiles in half the time.
function(tread_optimise_less target)
  target_compile_options(${target} PRIVATE $<$<AND:$<CONFIG:Release>,$<COMPILE_LANGUAGE:CXX>>:-O1>)
endfunction()

# tread_room(NAME [LINK targets...] [PRECOMPILE headers...]): one room, one target. Takes every .cpp of the folder and of its
# sub-folders and, with CUDA, every .cu.
function(tread_room name)
  cmake_parse_arguments(ROOM "" "" "LINK;PRECOMPILE" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  file(GLOB_RECURSE device_sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cu)
  if(TREAD_WITH_CUDA)
    # CMake from 3.31 on would compile several as one, too, but their names clash.
    set_source_files_properties(${device_sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    list(APPEND sources ${device_sources})
  endif()
  add_library(tread_${name} STATIC ${sources})
  target_link_libraries(tread_${name} PUBLIC tread_flags ${ROOM_LINK})
  set_target_properties(tread_${name} PROPERTIES CUDA_RUNTIME_LIBRARY Static)
  if(TREAD_PYTHON_MODULE)
    # For a shared library in which nothing outside replaces a function: they are inlined as in the program.
    set_target_properties(tread_${name} PROPERTIES POSITION_INDEPENDENT_CODE ON)
    target_compile_options(tread_${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fno-semantic-interposition>)
  endif()
  tread_precompile(tread_${name} ${ROOM_PRECOMPILE})
  if(TREAD_GPU_SYNTAX AND device_sources)
    tread_gpu_syntax(tread_${name}_gpu_syntax SOURCES ${device_sources} LINK ${ROOM_LINK})
  endif()
endfunction()

# tread_gpu_syntax(NAME SOURCES files... LINK targets...): nvcc reads GPU code and makes none. It reads the files of a folder as one,
# in a quarter of the time: most of what a file takes is its headers.
function(tread_gpu_syntax name)
  cmake_parse_arguments(CHECK "" "" "SOURCES;LINK" ${ARGN})
  foreach(source ${CHECK_SOURCES})
    cmake_path(GET source PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${PROJECT_SOURCE_DIR}/src OUTPUT_VARIABLE folder)
    string(REPLACE "/" "_" folder ${folder})
    string(APPEND includes_${folder} "#include \"${source}\"\n")
    list(APPEND folders ${folder})
  endforeach()
  list(REMOVE_DUPLICATES folders)
  list(TRANSFORM folders REPLACE "(.+)" "${CMAKE_CURRENT_BINARY_DIR}/gpu_syntax/\\1.cu" OUTPUT_VARIABLE files)
  foreach(folder file IN ZIP_LISTS folders files)
    file(CONFIGURE OUTPUT ${file} CONTENT "${includes_${folder}}")
  endforeach()
  add_library(${name} OBJECT ${files})
  target_link_libraries(${name} PRIVATE tread_flags ${CHECK_LINK})
  target_compile_definitions(${name} PRIVATE TREAD_WITH_CUDA)
  target_compile_options(${name} PRIVATE -fdevice-syntax-only)
  list(GET CMAKE_CUDA_ARCHITECTURES 0 architecture) # PTX is of one
  set_target_properties(${name} PROPERTIES CUDA_PTX_COMPILATION ON CUDA_ARCHITECTURES ${architecture} UNITY_BUILD OFF)
  add_dependencies(gpu_syntax ${name})
endfunction()
