#pragma once

#include "server/store/sqlite/database.h"

namespace modelsynth::server {

// A newer program made the tables.
class NewerSchema : public SqliteError {
  public:
    using SqliteError::SqliteError;
};

// Whether there are no tables yet.
[[nodiscard]] bool is_new(Database& database);

// Checks the database for damage and brings its tables to the form that this program knows:
// makes them in a new file, goes forward from an older form, one step after the other.
// Throws SqliteError when the file is damaged, NewerSchema when a newer program made it.
void prepare_schema(Database& database);

}  // namespace modelsynth::server
