"""What all records of the case file have in common."""

from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict
from pydantic_core import PydanticCustomError


class CaseModel(BaseModel):
    """A frozen record of the case file: unknown keys, NaN and infinity are refused."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, allow_inf_nan=False, validate_default=False, use_attribute_docstrings=True
    )


def _name(text: str) -> str:
    if not (0 < len(text) <= 64 and text[0].isalnum() and all(c.isalnum() or c in "-_+ " for c in text)):
        raise PydanticCustomError(
            "bad_name",
            "a name is made of letters, digits, '-', '_', '+' and spaces, begins with a letter or a digit "
            "and has at most 64 characters",
        )
    return text


Name = Annotated[str, AfterValidator(_name)]
