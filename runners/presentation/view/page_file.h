// An HTML page of the viewer: its script and style, what to show as JSON, and numbers, compressed.
#pragma once

#include <string>

namespace remote_touch {

// json: names the arrays in bytes by PackedArray. Throws InputError without viewer_script().
std::string page_file(const std::string& title, const std::string& json, const std::string& bytes);

// Returns the bytes as a page stores them: gzip, then Base64.
std::string gzip_base64(const std::string& bytes);

}  // namespace remote_touch
