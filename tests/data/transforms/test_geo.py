"""Places on the earth, against PROJ."""

from __future__ import annotations

import math

import numpy as np
import pyproj
import pytest
from hypothesis import given
from hypothesis import strategies as st

from webviz.data.geo import MAX_LATITUDE, Geodetic, TilePlane, is_valid, to_ecef, to_enu, to_utm

LATITUDES = st.floats(-90, 90)
LONGITUDES = st.floats(-180, 180)
ALTITUDES = st.floats(-500, 10_000)
PLACES = st.builds(Geodetic, LATITUDES, LONGITUDES, ALTITUDES)

ECEF = pyproj.Transformer.from_crs("EPSG:4979", "EPSG:4978")
MERCATOR = pyproj.Transformer.from_crs("EPSG:4326", "EPSG:3857", always_xy=True)


@given(place=PLACES)
def test_earth_centred_coordinates_are_those_of_proj(place: Geodetic) -> None:
    np.testing.assert_allclose(to_ecef([place]), [ECEF.transform(*place)], atol=1e-6)


@given(origin=PLACES, place=PLACES)
def test_local_coordinates_are_those_of_proj(origin: Geodetic, place: Geodetic) -> None:
    plane = pyproj.Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
        "+step +proj=cart +ellps=WGS84 +step +proj=topocentric +ellps=WGS84 "
        f"+lon_0={origin.longitude!r} +lat_0={origin.latitude!r} +h_0={origin.altitude!r}"
    )
    expected = plane.transform(place.longitude, place.latitude, place.altitude)
    np.testing.assert_allclose(to_enu([place], origin), [expected], atol=1e-5)


@given(latitude=st.floats(-80, 84), longitude=st.floats(-180, 179.999))
def test_utm_is_that_of_proj_in_the_zone_it_names(latitude: float, longitude: float) -> None:
    result = to_utm(latitude, longitude)
    assert result is not None
    south = " +south" if latitude < 0 else ""
    zone = pyproj.Proj(f"+proj=utm +zone={result.zone}{south} +ellps=WGS84")
    np.testing.assert_allclose(
        (result.easting, result.northing), zone(longitude, latitude), atol=1e-3
    )


@pytest.mark.parametrize(
    ("latitude", "longitude", "zone"),
    [
        (48.0, 11.5, "32U"),
        (60.0, 5.0, "32V"),  # Bergen: the zone of Norway is wider
        (78.0, 15.0, "33X"),  # Svalbard has four zones
        (-33.9, 151.2, "56H"),
        (0.0, 180.0, "1N"),
        (83.9, -0.1, "30X"),
    ],
)
def test_zones_and_bands_have_their_exceptions(
    latitude: float, longitude: float, zone: str
) -> None:
    assert str(to_utm(latitude, longitude)).split()[0] == zone


def test_poles_have_no_utm_coordinates() -> None:
    assert to_utm(84.1, 0.0) is None
    assert to_utm(-80.1, 0.0) is None
    assert to_utm(math.nan, 0.0) is None


@pytest.mark.parametrize("bad", [(math.nan, 0.0), (0.0, math.inf), (90.1, 0.0), (0.0, 1e308)])
def test_invalid_latitudes_and_longitudes_are_refused(bad: tuple[float, float]) -> None:
    assert not is_valid(*bad)


@given(
    latitude=st.floats(-85, 85),
    longitude=st.floats(-180, 179.99),
    zoom=st.integers(0, 22),
)
def test_tiles_are_those_of_the_projection(latitude: float, longitude: float, zoom: int) -> None:
    x, y = MERCATOR.transform(longitude, latitude)
    edge = MERCATOR.transform(180.0, 0.0)[0]
    expected = (x / edge + 1.0) / 2.0 * 2**zoom, (1.0 - y / edge) / 2.0 * 2**zoom
    result = TilePlane(Geodetic(latitude, longitude), zoom).center
    np.testing.assert_allclose(result, expected, rtol=1e-9, atol=1e-9)


@given(latitude=st.floats(-80, 80), longitude=st.floats(-179, 179))
def test_corners_of_tiles_lie_where_their_places_are(latitude: float, longitude: float) -> None:
    origin = Geodetic(latitude, longitude)
    plane = TilePlane(origin, 18)
    column, row = plane.around(0)[0]
    edge = MERCATOR.transform(180.0, 0.0)[0]
    corner = MERCATOR.transform(
        edge * (2.0 * column / plane.count - 1.0),
        edge * (1.0 - 2.0 * (row + 1) / plane.count),
        direction="INVERSE",
    )
    east, north, _ = to_enu([(corner[1], corner[0], 0.0)], origin)[0]
    # Within a tile of 150 m the plane bends by less than 5 mm, near the poles more.
    np.testing.assert_allclose(plane.corner(column, row), (east, north), atol=0.02)


def test_tiles_around_a_place_begin_with_its_own_and_end_at_the_poles() -> None:
    plane = TilePlane(Geodetic(MAX_LATITUDE, 0.0), 3)
    assert plane.around(1) == [(4, 0), (3, 0), (4, 1), (5, 0), (3, 1), (5, 1)]
    assert TilePlane(Geodetic(0.0, 0.0), 0).around(5) == [(0, 0)], "there is one tile"
