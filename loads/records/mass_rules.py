"""What may weigh: where weight or inertia acts, the case file says of every moving link where its mass comes from."""

from collections.abc import Collection

from geometry.base.errors import CaseError


def check_masses(
    *, moving: Collection[str], with_part: Collection[str], carrying: Collection[str], massless: Collection[str]
) -> None:
    """Raise ``CaseError`` where a link is stated massless that does not exist, has a part or carries a mass."""
    for link in massless:
        if link not in moving:
            raise CaseError(f"massless: '{link}' is not a moving link; choose among {', '.join(moving)}")
        if link in with_part or link in carrying:
            what = "has a part" if link in with_part else "carries a mass"
            raise CaseError(f"massless: link '{link}' {what}, so it weighs something; remove one of the two statements")


def check_weighed(
    entry: str,
    *,
    moving: Collection[str],
    with_part: Collection[str],
    carrying: Collection[str],
    massless: Collection[str],
) -> None:
    """Raise ``CaseError`` where ``entry`` asks for weight or inertia and nothing says what some link weighs."""
    for link in moving:
        if link not in with_part and link not in carrying and link not in massless:
            raise CaseError(
                f"{entry}: link '{link}' has neither a part nor a mass, so nothing says what it weighs; give it a "
                f'part, a mass under [[carried]], or state massless = ["{link}"]'
            )
