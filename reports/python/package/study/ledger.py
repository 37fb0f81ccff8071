"""The ledger of a study: a row for each variant that was computed, in a file of SQLite.

variants(k, outcome, method, reason, f1, f2, ..., checksum); witnesses likewise, by the equilibrium leg; the view
`results` has the names of the figures. A process that is killed leaves a ledger without the rows of its open transaction.
"""
import contextlib
import fcntl
import hashlib
import marshal
import os
import sqlite3

import numpy as np

from elastocheck._errors import FileError

FORMAT = "elastocheck/ledger/4"
OUTCOMES = ["solved", "no scene", "not trimmed", "ended early", "no value"]
TABLES = ("variants", "witnesses")


def checksum(row):
    """Checksum of the content of a row (k, outcome, method, reason, figures...), its types included."""
    content = marshal.dumps(row, 2)  # the last version in which equal values have equal bytes
    return int.from_bytes(hashlib.blake2b(content, digest_size=8).digest(), "little", signed=True)


@contextlib.contextmanager
def naming(file):
    """Errors of SQLite name the ledger."""
    try:
        yield
    except sqlite3.Error as error:
        raise FileError(f"{file}: {error}") from error


@contextlib.contextmanager
def locked(ledger):
    """Excludes other processes that would write the same ledger."""
    # Beside the ledger: SQLite loses its own locks where the file itself is opened once more.
    lock = os.open(ledger + ".lock", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC | os.O_NOFOLLOW, 0o666)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        yield
    except BlockingIOError as error:
        raise FileError(f"{ledger}: another process is computing this study here") from error
    finally:
        os.close(lock)


class Ledger:
    """Opens, or to write creates, the ledger of a study, and checks every row.

    `damaged` are the tables and numbers of rows that were changed or hurt; to write they are removed, so that they
    are computed again. To write, the version of the program has to be the same.
    """

    def __init__(self, file, study, write=True, same_version=True):
        self.file, self.figures, self.damaged = file, len(study.figures), []
        if os.path.islink(file):
            raise FileError(f"{file}: is a symbolic link; a ledger is a regular file")
        if not write and not os.path.exists(file):
            raise FileError(f"{file}: no such ledger; nothing has been computed")
        with naming(file):
            self.base = sqlite3.connect(file, timeout=10)
            # Damaged text is found by its checksum.
            self.base.text_factory = lambda text: text.decode(errors="replace")
            if write and not self.rows("SELECT 1 FROM sqlite_master"):
                self._create(study)
            self._check_identity(study.identity, same_version)
            for table in TABLES:
                self.damaged += [(table, row[0]) for row, intact in self._checked(table) if not intact]
            if self.damaged or self.rows("PRAGMA quick_check(1)") != [("ok",)]:
                if not write:
                    rows = "; ".join(f"row {k} of {table}: its content is not that of its checksum" for table, k in self.damaged[:3])
                    raise FileError(f"{file}: is damaged: {rows}; the study without --show computes again what is")
                for table in TABLES:  # written anew: in a damaged table rows are not found by their numbers
                    rows = [row for row, intact in self._checked(table) if intact]
                    with self.base:
                        self.base.execute(f"DELETE FROM {table}")
                        self._insert(table, rows)
            if write and study.witness:  # a variant is computed together with its witness
                with self.base:
                    self.base.execute("DELETE FROM variants WHERE k % ? = 0 AND k NOT IN (SELECT k FROM witnesses)", (study.witness,))

    def rows(self, sql, *values):
        return self.base.execute(sql, values).fetchall()

    def _checked(self, table):
        """Rows, and whether each is as it was written."""
        return ((row, checksum(row[:-1]) == row[-1]) for row in self.base.execute(f"SELECT * FROM {table} ORDER BY k"))

    def _create(self, study):
        figures = "".join(f"f{j + 1} REAL, " for j in range(self.figures))
        named = "".join(', f{} AS "{}"'.format(j + 1, f.name.replace('"', '""')) for j, f in enumerate(study.figures))
        with self.base:
            self.base.execute("BEGIN")
            self.base.execute("CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT)")
            self.base.executemany("INSERT INTO meta VALUES (?, ?)", [*study.identity.items(), ("format", FORMAT)])
            for table in TABLES:
                self.base.execute(f"CREATE TABLE {table} (k INTEGER PRIMARY KEY, outcome TEXT NOT NULL, method TEXT NOT NULL,"
                                  f" reason TEXT, {figures}checksum INTEGER NOT NULL)")
            self.base.execute(f"CREATE VIEW results AS SELECT k, outcome, method, reason{named} FROM variants")

    def _check_identity(self, identity, same_version):
        """Rows of several versions of the program are not added to each other."""
        there = dict(self.rows("SELECT key, value FROM meta"))
        if there.get("format") != FORMAT:
            raise FileError(f"{self.file}: not a ledger of a study")
        for key, what in [("scene", "scene"), ("study", "study file"), ("version", "version of the program")]:
            if there.get(key) != identity[key] and (same_version or key != "version"):
                raise FileError(f"{self.file}: is of another {what}: {there.get(key)} there, {identity[key]} here; "
                                f"another {what} needs another folder")

    def add(self, *of_tables):
        """Adds rows of variants and of witnesses, without checksums, in one transaction."""
        with self.base:
            for table, rows in zip(TABLES, of_tables):
                self._insert(table, [(*row, checksum(row)) for row in rows])

    def _insert(self, table, rows):
        self.base.executemany(f"INSERT OR REPLACE INTO {table} VALUES ({', '.join('?' * (self.figures + 5))})", rows)

    def merge(self, other):
        """Adds the rows of another ledger of this study that are not here yet; one with other values is an error."""
        self.base.execute("ATTACH ? AS other", (other.file,))
        with self.base:
            for table in TABLES:
                for k, in self.rows(f"SELECT k FROM other.{table} o JOIN main.{table} m USING (k) WHERE o.checksum != m.checksum LIMIT 1"):
                    raise FileError(f"{other.file}: variant {k} has other values than in {self.file}")
                self.base.execute(f"INSERT OR IGNORE INTO main.{table} SELECT * FROM other.{table}")
        self.base.execute("DETACH other")

    def present(self, count):
        """Whether each variant below `count` has a row."""
        has = np.zeros(count, bool)
        has[self._columns("SELECT k FROM variants WHERE k < ?", "i8", count)["f0"]] = True
        return has

    def values(self, j, count, table="variants"):
        """Values of figure j by variant; nan where there is none."""
        values, f = np.full(count, np.nan), f"f{j + 1}"
        there = self._columns(f"SELECT k, {f} FROM {table} WHERE k < ? AND {f} IS NOT NULL", "i8,f8", count)
        values[there["f0"]] = there["f1"]
        return values

    def content_hash(self, count):
        """Hash of the checksums of all rows of variants below `count`: equal for equal content."""
        content = hashlib.blake2b(digest_size=8)
        for table in TABLES:
            content.update(self._columns(f"SELECT checksum FROM {table} WHERE k < ? ORDER BY k", "i8", count).tobytes())
        return content.hexdigest()

    def _columns(self, sql, types, *values):
        """The columns of a query, which are numbers, as the fields f0, f1, ... of a structured array."""
        return np.fromiter(self.base.execute(sql, values), np.dtype([(f"f{j}", t) for j, t in enumerate(types.split(","))]))
