"""Long work: a row for people, a DBOS workflow for durability, a worker process that does it."""
