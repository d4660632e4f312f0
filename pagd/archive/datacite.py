"""What a repository that gives out DOIs asks of a data set, as DataCite names it.

DataCite Metadata Schema 4.5, https://schema.datacite.org/meta/kernel-4.5/. The DOI itself is for
the repository to add, which is the publisher then.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import date
from typing import Final

from pagd.archive.card import DESCRIPTION, NAME
from pagd.archive.croissant import CREATOR, KEYWORDS, version_on

__all__ = ["DATACITE", "datacite"]

DATACITE: Final = "datacite.json"
_PAPER: Final = "Generative design of multimodal Soft Pneumatic Actuators"


def datacite(published: date, sizes: Mapping[str, int]) -> str:
    """Return the metadata as JSON text.

    Parameters
    ----------
    published
        Date of publication.
    sizes
        Bytes of the files, by path.
    """
    content = {
        "creators": [{"name": CREATOR, "nameType": "Organizational"}],
        "titles": [{"title": f"{NAME}: pneu-net actuators and what they do"}],
        "publisher": {"name": CREATOR},
        "publicationYear": str(published.year),
        "dates": [{"date": published.isoformat(), "dateType": "Issued"}],
        "types": {"resourceTypeGeneral": "Dataset", "resourceType": "Finite-element analyses"},
        "subjects": [{"subject": word} for word in KEYWORDS],
        "language": "en",
        "version": version_on(published),
        "formats": ["application/x-parquet"],
        "sizes": [f"{sum(sizes.values())} bytes", f"{len(sizes)} files"],
        "descriptions": [{"description": DESCRIPTION, "descriptionType": "Abstract"}],
        "rightsList": [
            {
                "rights": "MIT License",
                "rightsUri": "https://spdx.org/licenses/MIT.html",
                "rightsIdentifier": "MIT",
                "rightsIdentifierScheme": "SPDX",
            }
        ],
        "relatedItems": [
            {
                "titles": [{"title": _PAPER}],
                "creators": [{"name": name} for name in ("Ghosh", "Roy")],
                "relationType": "IsDerivedFrom",
                "relatedItemType": "JournalArticle",
            }
        ],
        "schemaVersion": "http://datacite.org/schema/kernel-4",
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"
