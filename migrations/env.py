"""Runs migrations on the connection that `server.database.migrate` gives, inside its transaction.

SQLite cannot alter most things of a table, so there a batch makes a new one. `metadata` is only given to compare.
"""

from alembic import context

connection = context.config.attributes["connection"]
context.configure(
    connection=connection,
    target_metadata=context.config.attributes.get("metadata"),
    render_as_batch=connection.dialect.name == "sqlite",
    transactional_ddl=True,
)
context.run_migrations()
