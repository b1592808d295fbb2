// Columns of figures that earlier versions wrote under other names.
#pragma once

#include <string>

namespace remote_touch {

// Returns the present name of a column that a figure of schema /2 has; any other name is returned as it is.
// name: that of the column, or table/column.
std::string present_column(const std::string& name);

}  // namespace remote_touch
