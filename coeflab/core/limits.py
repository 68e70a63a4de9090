"""How large an input may be, in one place, each limit with its reason.

The sizes of files follow from two bounds on what a wrong or hostile input may cost before it is refused: two seconds and
300 MB of memory on one core. Real inputs stand far below: the largest shipped text file has 90 kB, and tables of 100,000 rows,
parameter files with hulls of 100,000 facets and meshes of millions of faces are read.
"""

from __future__ import annotations

from coeflab.core.errors import InputError

# Text. Python's own parsers take 20 to 200 bytes of memory for a byte of text.
TOML_BYTES = 1 << 20
YAML_BYTES = 1 << 20
XML_BYTES = 8 << 20
JSON_BYTES = 16 << 20
M_FILE_BYTES = 1 << 18
RECORD_BYTES = 4 << 20  # files of a tow; that of 1,000 conditions has 500 kB

# What our own processes and solvers printed, from the end; a mesh of a tow, which a solver wrote: 20 million cells.
LOG_BYTES = 64 << 20
MESH_BYTES = 4 << 30

# Depth. Parsers call themselves once a level; Python allows some 1000 calls. Models nest 10 deep at most.
JSON_DEEPEST = 150
YAML_DEEPEST = 60
XML_DEEPEST = 200
ARITHMETIC_DEEPEST = 60
XACRO_DEEPEST = 30
# The parser of TOML keeps every beginning of a dotted key: n names cost n^2 of memory.
TOML_NAMES_IN_A_KEY = 60

# Counts. A table of TOML takes 6 microseconds and 600 bytes, a node of YAML 100 microseconds.
TOML_TABLES = 20_000
YAML_NODES = 20_000
YAML_NUMBER_LETTERS = 400  # YAML 1.1 multiplies 1:2:3:... out to base 60, at a cost of the square of the length
XML_ELEMENTS = 100_000
XACRO_TEXT = 1 << 16  # of one text
XACRO_WHOLE = 8 << 20  # of all texts together; each may double those before it
# An object that breaks the schema costs ten errors of 1 kB. The largest shipped parameter file has 700 objects.
JSON_OBJECTS = 50_000
JSON_KEYS = 2_000  # of one object
JSON_VALUES = 2_000_000
INTEGER_DIGITS = (
    4_300  # beyond, Python itself refuses to turn digits into a number, as the time grows with their square
)

# Delimited tables.
CSV_LINE = 1 << 16
CSV_CELLS = 2_000_000
CSV_BLANK_LINES = 1000

# Tables of other people's tools, as numbers 8 bytes a cell: 2,000,000 lines of 15 columns take 240 MB. A text takes 60 bytes.
TABLE_CELLS = 30_000_000
TABLE_TEXTS = 3_000_000
TABLE_COLUMNS = 2_000
TABLE_CUT_LINES = 20  # left out and said; beyond, and beyond one in a hundred, the dialect is wrong
# A spreadsheet is read at once, some 100 bytes a cell and 10 a byte of it; LibreOffice and Excel end at 1,048,576 rows.
SHEET_BYTES = 64 << 20
SHEET_UNPACKED = 256 << 20
SHEET_CELLS = 3_000_000

# Cases of OpenFOAM; a dictionary of a case has 10 kB.
FOAM_BYTES = 1 << 18  # besides the long lists of fields, which are passed over unread
FOAM_FIELD_BYTES = 64 << 20
FOAM_FILES = 200  # that one case includes, one file as often as it is included
FOAM_DEEPEST = 12
FOAM_VALUE = 4096
FOAM_ENTRIES = 100_000  # that dictionaries take over from one another
# Patterns of names: 300 steps on the 256 KiB of a list of patches.
PATTERN_STATES = 300
PATTERN_DEEPEST = 20
PATTERN_WORK = 3_000_000  # steps times letters of all names and patterns of one case; a second
# A history of forces: 12 components and a time take 100 bytes a row, at most 500 MB with 2 million rows.
HISTORY_ROWS = 5_000_000
# Monitors of solvers: 2 million lines of 25 columns are 400 MB of doubles.
MONITOR_NUMBERS = 50_000_000
MONITOR_COLUMNS = 2_000
MONITOR_FILES = 200  # that a folder of one run may hold

# Scenes. Where a mesh stands is found by walking from each node to the root: nodes times depth. Exporters nest 10 deep.
GLB_NODES = 10_000
GLB_DEEPEST = 40

# Motions: a row of a motion takes 1 kB until it is written, a step 20 microseconds.
MOTION_ROWS = 1_000_000
MOTION_STEPS = 5_000_000

# A table that `coeflab table` prints, piece by piece.
TABLE_POINTS = 5_000_000

# The 2.5 % percentile of 20,000 replicates is known to 1 % of the half-width of its interval, that of 100,000 members to
# half a per cent; more takes time and says no more.
REPLICATES = 20_000
MEMBERS = 100_000

# Numbers of people. A length enters by its fifth power, and products of several such are divided by each other; doubles end
# at 1e308. The universe is 1e27 m wide and an atom 1e-10 m; nothing that floats leaves these bounds in SI.
LARGEST_NUMBER = 1e18
SMALLEST_POSITIVE = 1e-18
# Of a part of a body, m.
SHORTEST_PART, LONGEST_PART = 1e-6, 1e4
# Of parameter files, whose coefficients may be those of high powers of small angles.
LARGEST_STORED = 1e100
# Steady motions that `trim` is asked for, m/s and rad/s: ten times those of any body in water.
FASTEST = 1e3


def bounded_number(value: float) -> str:
    """Why a number is out of all bounds, in words of what is expected; empty where it is not."""
    return "" if abs(value) <= LARGEST_NUMBER else f"a finite number from {-LARGEST_NUMBER:g} to {LARGEST_NUMBER:g}"


def positive_number(value: float) -> str:
    """Why a number that divides is no such one, in words of what is expected; empty where it is."""
    if SMALLEST_POSITIVE <= value <= LARGEST_NUMBER:
        return ""
    return "a value above zero" + (f", from {SMALLEST_POSITIVE:g} to {LARGEST_NUMBER:g}" if value > 0.0 else "")


def require_rows(rows: float, column: str, advice: str) -> None:
    """Refuse a motion of more rows than memory holds.

    Parameters
    ----------
    rows : float
        Duration over the time between rows; may be infinite.
    column, advice : str
        For the error.

    Raises
    ------
    InputError
    """
    if not rows <= MOTION_ROWS:
        raise InputError(f"{rows:.3g} rows of a motion", f"at most {MOTION_ROWS:,}", column=column, advice=advice)
