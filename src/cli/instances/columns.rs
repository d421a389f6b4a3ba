//! Objects as columns: Apache Parquet, with the columns of the table.

use super::kind_and_scale;
use crate::life::Instance;
use crate::planet::Planet;
use crate::sphere::LatLon;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::SortingColumn;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::parser::parse_message_type;
use parquet::schema::types::ColumnPath;
use std::fs::File;
use std::io;
use std::sync::Arc;

/// Columns of the file.
const SCHEMA: &str = "message instances {
    required int64 id (integer(64, false));
    required binary kind (string);
    required double latitude_deg;
    required double longitude_deg;
    required double height_m;
    required float turn_deg;
    required float scale;
    required float qx;
    required float qy;
    required float qz;
    required float qw;
}";

/// Rows that are in memory as columns at a time.
const GROUP_ROWS: usize = 1 << 18;

/// Writes a file whose rows are in the order of the instances, which are sorted by id.
pub(super) fn write(file: &mut File, planet: &Planet, instances: &[Instance]) -> io::Result<()> {
    write_groups(file, planet, instances).map_err(io::Error::other)
}

fn write_groups(file: &mut File, planet: &Planet, instances: &[Instance]) -> Result<(), ParquetError> {
    let properties = WriterProperties::builder()
        .set_created_by(concat!("tellus ", env!("CARGO_PKG_VERSION")).to_owned())
        // Names repeat; numbers do not.
        .set_dictionary_enabled(false)
        .set_column_dictionary_enabled(ColumnPath::from("kind"), true)
        .set_sorting_columns(Some(vec![SortingColumn { column_idx: 0, descending: false, nulls_first: false }]))
        .build();
    let schema = Arc::new(parse_message_type(SCHEMA)?);
    let mut writer = SerializedFileWriter::new(file, schema, Arc::new(properties))?;
    let kinds: Vec<ByteArray> = planet.life.iter().map(|population| population.name.as_str().into()).collect();
    for part in instances.chunks(GROUP_ROWS) {
        let mut group = writer.next_row_group()?;
        let all = || part.iter();
        let (lat_deg, lon_deg): (Vec<f64>, Vec<f64>) =
            all().map(|one| LatLon::from_direction(one.dir_planet).to_degrees()).unzip();
        // The bits of a number without a sign.
        add::<Int64Type>(&mut group, &all().map(|one| one.id.cast_signed()).collect::<Vec<_>>())?;
        let names = all().map(|one| kinds[usize::from(one.population)].clone());
        add::<ByteArrayType>(&mut group, &names.collect::<Vec<_>>())?;
        add::<DoubleType>(&mut group, &lat_deg)?;
        add::<DoubleType>(&mut group, &lon_deg)?;
        add::<DoubleType>(&mut group, &all().map(|one| one.base_m).collect::<Vec<_>>())?;
        add::<FloatType>(&mut group, &all().map(|one| one.turn_rad.to_degrees() as f32).collect::<Vec<_>>())?;
        add::<FloatType>(&mut group, &all().map(|one| kind_and_scale(planet, one).1 as f32).collect::<Vec<_>>())?;
        let turns: Vec<[f64; 4]> = all().map(|one| one.local_from_form().to_array()).collect();
        for part in 0..4 {
            add::<FloatType>(&mut group, &turns.iter().map(|turn| turn[part] as f32).collect::<Vec<_>>())?;
        }
        group.close()?;
    }
    writer.close()?;
    Ok(())
}

/// Writes the next column of a group.
fn add<T: DataType>(group: &mut SerializedRowGroupWriter<'_, &mut File>, values: &[T::T]) -> Result<(), ParquetError> {
    let Some(mut column) = group.next_column()? else {
        return Err(ParquetError::General("the schema has fewer columns than are written".to_owned()));
    };
    column.typed::<T>().write_batch(values, None, None)?;
    column.close()
}
