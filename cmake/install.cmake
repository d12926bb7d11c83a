# cmake --install BUILD --prefix PREFIX: the program, the scripts that it becomes and that read its runs, scenes, pages, and
# completion for bash. The program finds its scripts by its own place, so that a prefix may be moved.
set_target_properties(tread PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
install(TARGETS tread RUNTIME)
set(share ${CMAKE_INSTALL_DATAROOTDIR}/tread)
install(DIRECTORY jobs postprocess configs docs DESTINATION ${share} USE_SOURCE_PERMISSIONS
        PATTERN __pycache__ EXCLUDE)
install(FILES README.md CHANGELOG.md CITATION.cff LICENSE DESTINATION ${share})
install(FILES packaging/tread.bash DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions RENAME tread)
