# Tests of some modules with the address and undefined behaviour sanitizers, beside a build without them: the sources of these modules
# and their tests are compiled once more; the other modules come from the library. scripts/test --deep selects a tenth of the modules
# for each commit; the preset "asan" (scripts/test --sanitize) covers all of them.
set(OSTRAKA_SANITIZED_MODULES "" CACHE STRING "Modules whose tests are also run with sanitizers")
if(OSTRAKA_SANITIZED_MODULES)
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()
foreach(module IN LISTS OSTRAKA_SANITIZED_MODULES)
  file(GLOB sources CONFIGURE_DEPENDS src/${module}/*.cpp src/${module}/*/*.cpp)
  file(GLOB tests CONFIGURE_DEPENDS test/${module}/*_test.cpp)
  if(NOT sources OR NOT tests)
    continue()
  endif()
  add_executable(sanitized_${module} ${sources} ${tests})
  set_source_files_properties(${tests} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set_target_properties(sanitized_${module} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 16)
  get_target_property(definitions ostraka_test_base INTERFACE_COMPILE_DEFINITIONS)
  # Matrices allocated in the library are freed here: Eigen must allocate them alike, which it does not do with sanitizers by itself.
  target_compile_definitions(sanitized_${module} PRIVATE ${definitions} RAPIDJSON_HAS_STDSTRING=1 EIGEN_MALLOC_ALREADY_ALIGNED=1)
  target_compile_options(sanitized_${module} PRIVATE -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all
    -fno-omit-frame-pointer -Wno-subobject-linkage)
  # The linker keeps the first definition of a function: the sanitized one, not that of the library.
  target_link_options(sanitized_${module} PRIVATE -fsanitize=address,undefined LINKER:--allow-multiple-definition)
  get_target_property(libraries ostraka LINK_LIBRARIES)
  target_include_directories(sanitized_${module} PRIVATE src test)
  target_link_libraries(sanitized_${module} PRIVATE ostraka ostraka_flags ${libraries} GTest::gtest GTest::gtest_main)
  add_dependencies(sanitized_${module} ostraka_command)
  gtest_discover_tests(sanitized_${module} TEST_PREFIX Sanitized. PROPERTIES LABELS sanitized TIMEOUT 1800 DISCOVERY_TIMEOUT 60)
endforeach()
