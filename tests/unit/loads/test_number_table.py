"""A table of numbers: what spreadsheets write is read right, or refused with row and column."""

import numpy as np
import pytest

from alula.geometry.base.errors import CaseError
from alula.loads.text.number_table import number_table, read_number_table

PLAIN = "cycle [%],Fy [N],M [N*m]\n0,-10.5,1\n50,-20,2e1\n100,-10.5,1\n"


def column(text: str, name: str = "Fy") -> list[float]:
    """Return the numbers of a column."""
    return number_table(text, "gait.csv").values[name].tolist()


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", "\t"),
        PLAIN.replace(",", ";").replace(".", ","),
        PLAIN.replace(",", "\t").replace(".", ","),
        PLAIN.replace("\n", "\r\n"),
        PLAIN.replace("\n", "\r"),
        "# gait of nobody; made up\n\n" + PLAIN.replace("\n50", "\n  # the middle\n\n50"),
        PLAIN.replace(",", " , ").replace("-", "−"),
        "Fy [N],M [N*m],cycle [%]\n-10.5,1,0\n-20,20,50\n-10.5,1,100\n",
        '"cycle [%]","Fy [N]","M [N*m]"\n"0","-10.5","1"\n50,-20,2e1\n100,-10.5,1\n',
    ],
)
def test_what_spreadsheets_write_is_read_alike(text):
    assert column(text) == [-10.5, -20.0, -10.5]
    assert column(text, "M") == [1.0, 20.0, 1.0]
    assert number_table(text, "gait.csv").units == {"cycle": "%", "Fy": "N", "M": "N*m"}


def test_a_file_may_begin_with_a_byte_order_mark(tmp_path):
    (tmp_path / "gait.csv").write_bytes(b"\xef\xbb\xbf" + PLAIN.encode())
    assert list(read_number_table(str(tmp_path), "gait.csv").units) == ["cycle", "Fy", "M"]
    (tmp_path / "gait.csv").write_bytes(PLAIN.encode("utf-16"))
    with pytest.raises(CaseError, match="not UTF-8 text"):
        read_number_table(str(tmp_path), "gait.csv")
    (tmp_path / "gait.csv").write_bytes(PLAIN.encode() + b"#" * (1 << 20))
    with pytest.raises(CaseError, match="larger than 1 MiB"):
        read_number_table(str(tmp_path), "gait.csv")
    with pytest.raises(CaseError, match=r"table '.*': there is no such file"):
        read_number_table(str(tmp_path), "none.csv")
    with pytest.raises(CaseError, match="a table needs the name of its file"):
        read_number_table(str(tmp_path), "nul\0.csv")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("50,-20", "50,", r"'gait\.csv', row 3, column Fy: the cell is empty; fill the gap"),
        ("50,-20", "50,nan", "row 3, column Fy: 'nan' is not one finite number"),
        ("50,-20", "50,1e999", "row 3, column Fy: '1e999' is not one finite number"),
        ("50,-20", "50,-20 N", "row 3, column Fy: '-20 N' is not one finite number; state it without its unit"),
        ("50,-20", '50,"-20,5"', "row 3, column Fy: the comma in '-20,5' may part decimals or thousands"),
        ("50,-20", "50,-20,5", "row 3: it has 4 values for 3 columns; numbers with decimal commas need semicolons"),
        ("50,-20,2e1", "50,-20", "row 3: it has 2 values for 3 columns; correct that row"),
        ("M [N*m]", "Fy [N]", "column 3: 'Fy' is there twice"),
        ("M [N*m]", "M", r"column 3: its head 'M' is no .*; write a head such as 'cycle \[%\],Fy \[N\]'"),
        ("M [N*m]", "", "column 3: its head '' is no name with a unit"),
        ("M [N*m]", "[N*m]", "is no name with a unit in brackets"),
        ("50,-20", '50,"-20', "it is not valid CSV"),
        ("0,-10.5,1\n50,-20,2e1\n", "", "at least two rows below it"),
    ],
)
def test_a_malformed_table_is_refused_with_row_and_column(old, new, told):
    assert old in PLAIN
    with pytest.raises(CaseError, match=told):
        number_table(PLAIN.replace(old, new, 1), "gait.csv")


def test_one_column_or_two_signs_for_decimals_are_refused():
    with pytest.raises(CaseError, match="needs a head such as"):
        number_table("cycle [%]\n0\n50\n", "gait.csv")
    mixed = PLAIN.replace(",", ";").replace("-20", "-1,234")
    with pytest.raises(CaseError, match=r"row 3, column Fy: the comma in '-1,234' may part decimals or thousands"):
        number_table(mixed, "gait.csv")


def test_columns_in_units_and_between_rows():
    table = number_table(PLAIN, "gait.csv")
    assert table.quantity("M", "moment").tolist() == [1000.0, 20_000.0, 1000.0]
    with pytest.raises(CaseError, match=r"row 2, column M: \"N\*m\" is not a unit of force"):
        table.quantity("M", "force")
    with pytest.raises(CaseError, match=r"has no column 'Fx'; its columns are cycle, Fy, M"):
        table.quantity("Fx", "force")
    between = table.between("cycle", np.array([0.0, 25.0, 75.0, 100.0]))
    np.testing.assert_allclose(between.values["Fy"], [-10.5, -15.25, -15.25, -10.5])
    assert between.rows == (2, 2, 3, 4)
    table.rising("cycle")
    with pytest.raises(CaseError, match=r"row 4, column cycle: 50 does not come after 50 in the row above"):
        number_table(PLAIN.replace("100", "50"), "gait.csv").rising("cycle")
