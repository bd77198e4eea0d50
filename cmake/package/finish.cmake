# cpack runs this on the unpacked package: Debian's places for the licence and the changelog, and compressed pages.
set(root ${CPACK_TEMPORARY_INSTALL_DIRECTORY}${CPACK_PACKAGING_INSTALL_PREFIX})
set(documentation ${root}/share/doc/${CPACK_PACKAGE_NAME})
file(REMOVE ${documentation}/LICENSE) # Debian's name is copyright
file(COPY ${CMAKE_CURRENT_LIST_DIR}/copyright DESTINATION ${documentation}) # INSTALL would add DESTDIR again
file(RENAME ${documentation}/CHANGELOG.md ${documentation}/changelog)
file(GLOB pages ${root}/share/man/man1/*.1)
# Without name and time: the same sources give the same bytes.
execute_process(COMMAND gzip --best --no-name --force ${pages} ${documentation}/changelog COMMAND_ERROR_IS_FATAL ANY)
