//! One source for what the CPU and the shaders share: Rust definitions, written out as WGSL and as bytes.
//!
//! [`uniform_struct!`] declares a struct once. It gives the Rust type, its WGSL declaration, and its bytes in the
//! layout of WGSL's uniform address space (WGSL specification, section 14.4.1: alignment and size).

use glam::{DMat3, Mat4, UVec2, Vec2, Vec3, Vec4};

/// A type that can stand in a uniform buffer.
pub(crate) trait Uniform {
    /// Alignment in bytes.
    const ALIGN: usize;
    /// Size in bytes.
    const SIZE: usize;
    /// Name of the type in WGSL.
    fn wgsl() -> String;
    /// All zeros.
    fn zero() -> Self;
    /// Writes the value to the first [`Uniform::SIZE`] bytes.
    fn write(&self, bytes: &mut [u8]);
}

macro_rules! plain {
    ($($Type:ty, $name:literal, $align:literal;)*) => {$(
        impl Uniform for $Type {
            const ALIGN: usize = $align;
            const SIZE: usize = size_of::<$Type>();
            fn wgsl() -> String {
                $name.to_owned()
            }
            fn zero() -> Self {
                Self::default()
            }
            fn write(&self, bytes: &mut [u8]) {
                bytes[..Self::SIZE].copy_from_slice(bytemuck::bytes_of(self));
            }
        }
    )*};
}

plain! {
    f32, "f32", 4;
    u32, "u32", 4;
    Vec2, "vec2f", 8;
    UVec2, "vec2u", 8;
    Vec3, "vec3f", 16;
    Vec4, "vec4f", 16;
    Mat4, "mat4x4f", 16;
}

impl<T: Uniform, const N: usize> Uniform for [T; N] {
    const ALIGN: usize = T::ALIGN;
    const SIZE: usize = {
        // The stride of an array in the uniform address space is a multiple of 16.
        assert!(T::SIZE.is_multiple_of(16));
        N * T::SIZE
    };
    fn wgsl() -> String {
        format!("array<{}, {N}>", T::wgsl())
    }
    fn zero() -> Self {
        std::array::from_fn(|_| T::zero())
    }
    fn write(&self, bytes: &mut [u8]) {
        for (item, bytes) in self.iter().zip(bytes.chunks_mut(T::SIZE)) {
            item.write(bytes);
        }
    }
}

/// Size of a struct whose fields have these alignments and sizes, a multiple of 16.
pub(crate) const fn struct_size(fields: &[(usize, usize)]) -> usize {
    let (mut offset, mut i) = (0_usize, 0);
    while i < fields.len() {
        offset = offset.next_multiple_of(fields[i].0) + fields[i].1;
        i += 1;
    }
    offset.next_multiple_of(16)
}

/// Declares a struct of a uniform buffer, see the module.
macro_rules! uniform_struct {
    (
        $(#[doc = $doc:literal])*
        $Name:ident { $($(#[doc = $field_doc:literal])* $field:ident: $Type:ty,)* }
    ) => {
        $(#[doc = $doc])*
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $Name {
            $($(#[doc = $field_doc])* pub(crate) $field: $Type,)*
        }

        impl Default for $Name {
            fn default() -> Self {
                Self { $($field: <$Type as $crate::render::wgsl::Uniform>::zero(),)* }
            }
        }

        impl $Name {
            /// The declaration in WGSL.
            pub(crate) fn declaration() -> String {
                let mut text = String::new();
                $(text += &format!("//{}\n", $doc);)*
                text += concat!("struct ", stringify!($Name), " {\n");
                $(
                    $(text += &format!("    //{}\n", $field_doc);)*
                    let name = <$Type as $crate::render::wgsl::Uniform>::wgsl();
                    text += &format!(concat!("    ", stringify!($field), ": {},\n"), name);
                )*
                text + "}\n"
            }
        }

        impl $crate::render::wgsl::Uniform for $Name {
            const ALIGN: usize = 16;
            const SIZE: usize = $crate::render::wgsl::struct_size(&[$((
                <$Type as $crate::render::wgsl::Uniform>::ALIGN,
                <$Type as $crate::render::wgsl::Uniform>::SIZE,
            )),*]);
            fn wgsl() -> String {
                stringify!($Name).to_owned()
            }
            fn zero() -> Self {
                Self::default()
            }
            fn write(&self, bytes: &mut [u8]) {
                let mut end = 0;
                $(
                    let offset = usize::next_multiple_of(end, <$Type as $crate::render::wgsl::Uniform>::ALIGN);
                    end = offset + <$Type as $crate::render::wgsl::Uniform>::SIZE;
                    $crate::render::wgsl::Uniform::write(&self.$field, &mut bytes[offset..end]);
                )*
                debug_assert!(end <= Self::SIZE);
            }
        }
    };
}
pub(crate) use uniform_struct;

/// The bytes of a uniform value.
pub(crate) fn bytes_of<T: Uniform>(value: &T) -> Vec<u8> {
    let mut bytes = vec![0; T::SIZE];
    value.write(&mut bytes);
    bytes
}

/// A constant as WGSL text.
pub(crate) trait Constant {
    /// Type and value.
    fn text(&self) -> (&'static str, String);
}

impl Constant for u32 {
    fn text(&self) -> (&'static str, String) {
        ("u32", format!("{self}u"))
    }
}

impl Constant for i32 {
    fn text(&self) -> (&'static str, String) {
        ("i32", format!("{self}"))
    }
}

impl Constant for f64 {
    fn text(&self) -> (&'static str, String) {
        ("f32", format!("{self:?}"))
    }
}

impl Constant for [f64; 2] {
    fn text(&self) -> (&'static str, String) {
        ("vec2f", format!("vec2f({:?}, {:?})", self[0], self[1]))
    }
}

impl Constant for [f64; 4] {
    fn text(&self) -> (&'static str, String) {
        ("vec4f", format!("vec4f({:?}, {:?}, {:?}, {:?})", self[0], self[1], self[2], self[3]))
    }
}

impl Constant for DMat3 {
    fn text(&self) -> (&'static str, String) {
        let column = |c: glam::DVec3| format!("vec3f({:?}, {:?}, {:?})", c.x, c.y, c.z);
        let columns = [self.x_axis, self.y_axis, self.z_axis].map(column);
        ("mat3x3f", format!("mat3x3f({})", columns.join(", ")))
    }
}

/// `const NAME: type = value;`
pub(crate) fn constant(name: &str, value: &dyn Constant) -> String {
    let (of, value) = value.text();
    format!("const {name}: {of} = {value};\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use wgpu::naga;

    uniform_struct! {
        /// An element.
        Element {
            /// Three.
            a: Vec3,
            /// One.
            b: f32,
        }
    }

    uniform_struct! {
        /// Fields whose alignments leave gaps.
        Mixed {
            /// Scalar.
            a: f32,
            /// Aligned to 8.
            b: Vec2,
            /// Aligned to 16.
            c: Vec3,
            /// Fits behind it.
            d: u32,
            /// Array.
            e: [Element; 3],
            /// Scalar again.
            f: u32,
            /// Matrix.
            g: Mat4,
        }
    }

    /// naga lays the declaration out as the bytes are written.
    #[test]
    fn bytes_have_the_layout_of_the_declaration() {
        let text = Element::declaration() + &Mixed::declaration() + "@group(0) @binding(0) var<uniform> mixed: Mixed;";
        let module = naga::front::wgsl::parse_str(&text).unwrap();
        let (_, mixed) = module.types.iter().find(|(_, of)| of.name.as_deref() == Some("Mixed")).unwrap();
        let naga::TypeInner::Struct { members, span } = &mixed.inner else { panic!("a struct") };
        let value = Mixed {
            a: 1.0,
            b: Vec2::new(2.0, 3.0),
            c: Vec3::new(4.0, 5.0, 6.0),
            d: 7,
            e: [Element { a: Vec3::splat(8.0), b: 9.0 }; 3],
            f: 10,
            g: Mat4::from_cols_array(&[11.0; 16]),
        };
        let bytes = bytes_of(&value);
        assert_eq!(bytes.len(), *span as usize);
        let at = |name: &str| {
            let member = members.iter().find(|member| member.name.as_deref() == Some(name)).unwrap();
            let offset = member.offset as usize;
            let bytes: [u8; 4] = bytes[offset..offset + 4].try_into().unwrap();
            (f32::from_le_bytes(bytes), u32::from_le_bytes(bytes))
        };
        assert_eq!([at("a").0, at("b").0, at("c").0, at("e").0, at("g").0], [1.0, 2.0, 4.0, 8.0, 11.0]);
        assert_eq!([at("d").1, at("f").1], [7, 10]);
    }
}
