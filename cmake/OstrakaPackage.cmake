# `cpack` makes a Debian package: the command, manual pages, completion, the library with its headers, the conformance kit, the Python
# module, and all licences (COPYRIGHT). dpkg-shlibdeps finds the dependencies on shared libraries.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME ostraka)
set(CPACK_PACKAGE_VENDOR "The Ostraka developers")
# The developers have no common address: whoever distributes the package is responsible for it and states the contact.
set(OSTRAKA_CONTACT "The Ostraka developers" CACHE STRING "Who answers for the package: NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT "${OSTRAKA_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_SCRIPT "")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# The module is for one version of Python; code that uses the library needs the headers it was compiled with.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, fonts-dejavu-core")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "g++, cmake, make, libcgal-dev, libeigen3-dev, libfmt-dev, libboost-dev, rapidjson-dev, libembree-dev, libssl-dev, libsuitesparse-dev, libcairo2-dev, libpugixml-dev, libraptor2-dev, zlib1g-dev, libminizip-dev, libexpat1-dev, libpng-dev, libjpeg-dev, libwebp-dev, libgif-dev, libmeshoptimizer-dev, libdraco-dev, libceres-dev")
set(CPACK_DEB_COMPONENT_INSTALL OFF)
install(FILES ${CMAKE_CURRENT_SOURCE_DIR}/COPYRIGHT DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/ostraka RENAME copyright)
include(CPack)
