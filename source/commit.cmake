# Run at every build: write the commit of SOURCE into the header OUTPUT, if it has changed. GIVEN: what to say where there is no git.
# It is dirty if what the program is made of has been changed; new results in doc/ do not make it so.
set(_commit "${GIVEN}")
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=10 --exclude=*
                  OUTPUT_VARIABLE _found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE _result)
  if(_result EQUAL 0)
    set(_commit "${_found}")
    execute_process(COMMAND git -C ${SOURCE} diff --quiet HEAD -- CMakeLists.txt cmake include source
                    OUTPUT_QUIET ERROR_QUIET RESULT_VARIABLE _changed)
    if(NOT _changed EQUAL 0)
      string(APPEND _commit "-dirty")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define ALLUVIUM_COMMIT \"${_commit}\"\n") # leaves a file alone that has this content
