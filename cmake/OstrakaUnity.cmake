# Batches of files that are compiled as one: files of one module, in the order of their names, so many a batch. What a batch saves
# is reading the same headers and making the same templates again for each file. Files that take long on their own, and those with
# flags of their own, stay alone.
set(OSTRAKA_UNITY_BATCH 8 CACHE STRING "Files a batch")
set(OSTRAKA_UNITY_ALONE src/axis/skeleton.cpp src/synthetic/shatter.cpp src/io/wrap.cpp src/point_cloud/point_cloud.cpp src/remesh/remesh.cpp
  src/core/dense.cpp src/point_cloud/point_surface.cpp src/interchange/feature_writer.cpp)

function(ostraka_unity target)
  get_target_property(sources ${target} SOURCES)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP UNITY_BUILD_UNIQUE_ID "")
  set(last "")
  foreach(source IN LISTS sources)
    file(RELATIVE_PATH name ${CMAKE_CURRENT_SOURCE_DIR} ${source})
    get_source_file_property(own_flags ${source} COMPILE_OPTIONS)
    if(NOT name MATCHES "^src/([a-z_]+)/" OR name IN_LIST OSTRAKA_UNITY_ALONE OR own_flags)
      continue()
    endif()
    if(NOT CMAKE_MATCH_1 STREQUAL last)
      set(last ${CMAKE_MATCH_1})
      set(count 0)
    endif()
    math(EXPR batch "${count} / ${OSTRAKA_UNITY_BATCH}")
    math(EXPR count "${count} + 1")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${last}_${batch})
  endforeach()
endfunction()
