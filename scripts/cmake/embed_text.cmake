# Writes a text file into the program. FILE: the text, OUTPUT: the C++ file, HEADER: what declares the constant NAME, a
# const char* const in remote_touch.
file(READ ${FILE} text)
file(WRITE ${OUTPUT} "// Written by the build; edit the text itself.\n#include \"${HEADER}\"\n\nnamespace remote_touch {\n\nconst char* const ${NAME} = R\"embedded(${text})embedded\";\n\n}  // namespace remote_touch\n")
