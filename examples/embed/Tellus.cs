// Declarations of include/tellus.h for C# (.NET, Unity, Godot), and a class over them. Copy this file into a project and
// put the shared library where the engine looks for native libraries (Unity: Assets/Plugins). See docs/embedding.md.

using System;
using System.Runtime.InteropServices;
using System.Text;

namespace Tellus
{
    /// The surface under one direction. The layout is that of TellusSample in tellus.h.
    [StructLayout(LayoutKind.Sequential)]
    public struct Sample
    {
        /// Height of the ground above the reference sphere, below the sea too.
        public double HeightM;
        /// Surface of the sea, lake or river over the ground; NaN where there is none.
        public double WaterLevelM;
        /// Unit normal of the ground in the planet frame.
        public double NormalX, NormalY, NormalZ;
        /// Angle between the ground and the horizontal.
        public double SlopeRad;
        /// Temperature at the surface.
        public double TemperatureC;
        /// Rain and snow in a year.
        public double RainMm;
        /// Index of the biome; see Planet.BiomeName.
        public uint Biome;
    }

    /// How much of the sky clouds cover, each 0 to 1. The layout is that of TellusClouds in tellus.h.
    [StructLayout(LayoutKind.Sequential)]
    public struct Clouds
    {
        public double Low, Middle, Veil;
        /// A share of the ground.
        public double Fog;
    }

    /// Where a capsule that moves touches the ground. The layout is that of TellusContact in tellus.h.
    [StructLayout(LayoutKind.Sequential)]
    public struct Contact
    {
        /// Share of the motion until it touches, 0 to 1.
        public double Share;
        /// Distance between the surfaces there; negative: how far the capsule must move along the normal to be free.
        public double GapM;
        /// The point of the ground, metres from the centre.
        public double PointX, PointY, PointZ;
        /// Unit vector from the ground to the capsule.
        public double NormalX, NormalY, NormalZ;
    }

    /// An object that stands on the ground. The layout is that of TellusInstance in tellus.h.
    [StructLayout(LayoutKind.Sequential)]
    public struct Instance
    {
        public ulong Id;
        /// Seed of its population: with the id it names the object.
        public uint Seed;
        /// Index of its population; see Planet.PopulationName.
        public uint Population;
        /// Unit direction of its place.
        public double DirectionX, DirectionY, DirectionZ;
        /// Heights of the ground and of its foot above the reference sphere.
        public double GroundM, BaseM;
        /// Unit vector from its foot to its top.
        public double AxisX, AxisY, AxisZ;
        /// Turn about the axis, against the clock as seen from the top.
        public double TurnRad;
        /// Height along its axis.
        public double SizeM;
        /// Factor on the colours of its population.
        public double Brightness;
        public uint Variant;
        public uint Reserved;

        public ObjectName Name => new ObjectName { Id = Id, Seed = Seed };
    }

    /// The name of an object among all of a planet, for saves. The layout is that of TellusObject in tellus.h.
    [StructLayout(LayoutKind.Sequential)]
    public struct ObjectName
    {
        public ulong Id;
        public uint Seed;
        public uint Reserved;
    }

    /// A call failed; the message says why.
    public sealed class TellusException : Exception
    {
        public TellusException(string message) : base(message) { }
    }

    /// A planet. Any number of threads may ask at once; dispose of it when none does any more.
    public sealed class Planet : SafeHandle
    {
        // The runtime creates the handle that a function returns.
        private Planet() : base(IntPtr.Zero, true) { }

        public override bool IsInvalid => handle == IntPtr.Zero;

        protected override bool ReleaseHandle()
        {
            Native.tellus_planet_free(handle);
            return true;
        }

        /// Loads a preset. Solved maps of a structure are kept in cacheFolder, if there is one.
        public static Planet FromFile(string path, string cacheFolder = null)
        {
            return Loaded(Native.tellus_planet_from_file(Utf8(path), Utf8(cacheFolder)));
        }

        /// Loads a preset from text; name stands for the file in messages.
        public static Planet FromText(string name, string preset, string cacheFolder = null)
        {
            return Loaded(Native.tellus_planet_from_text(Utf8(name), Utf8(preset), Utf8(cacheFolder)));
        }

        public static string LibraryVersion => Text(Native.tellus_version());

        public string Name => Text(Native.tellus_name(this));

        /// 32 hexadecimal digits, equal for equal planets on every machine.
        public string Hash => Text(Native.tellus_hash(this));

        public double RadiusM => Native.tellus_radius_m(this);

        public uint BiomeCount => Native.tellus_biome_count(this);

        public string BiomeName(uint biome)
        {
            IntPtr name = Native.tellus_biome_name(this, biome);
            Check(name != IntPtr.Zero);
            return Text(name);
        }

        /// The unit direction (x, y, z) of a place in the planet frame.
        public static double[] Direction(double latDeg, double lonDeg)
        {
            var direction = new double[3];
            Check(Native.tellus_direction(latDeg, lonDeg, direction));
            return direction;
        }

        /// Heights of the ground under directions of three numbers each. Rivers and valleys that points spacingM metres
        /// apart would not show are left out: far cheaper where points are spread over the planet.
        public double[] Heights(double[] directions, double spacingM = 0)
        {
            var heightsM = new double[Count(directions)];
            Check(Native.tellus_heights_spaced(this, directions, (UIntPtr)heightsM.Length, spacingM, heightsM));
            return heightsM;
        }

        /// The surface under directions of three numbers each.
        public Sample[] Samples(double[] directions)
        {
            var samples = new Sample[Count(directions)];
            Check(Native.tellus_samples(this, directions, (UIntPtr)samples.Length, samples));
            return samples;
        }

        /// Distance along a ray to the ground or the sea; infinite if it meets neither.
        public double Raycast(double[] originM, double[] direction)
        {
            if (originM.Length != 3 || direction.Length != 3)
                throw new ArgumentException("an origin and a direction have three numbers each");
            double distanceM = Native.tellus_raycast(this, originM, direction);
            Check(!double.IsNaN(distanceM));
            return distanceM;
        }

        /// A square of the globe: positions in metres from the centre, unit normals and triangles, three numbers each.
        public void Tile(uint face, uint level, uint x, uint y, uint side,
            out double[] positionsM, out float[] normals, out uint[] indices)
        {
            if (side < 2 || side > MaxTileSide)
                throw new ArgumentOutOfRangeException(nameof(side), side, "use 2 to " + MaxTileSide);
            positionsM = new double[3 * side * side];
            normals = new float[3 * side * side];
            indices = new uint[6 * (side - 1) * (side - 1)];
            Check(Native.tellus_tile(this, face, level, x, y, side, positionsM, normals));
            Check(Native.tellus_tile_indices(side, indices));
        }

        public const uint MaxTileSide = 4097;
        public const uint MaxChunkCells = 1024;

        /// Clouds over directions of three numbers each at a time.
        public Clouds[] CloudsAt(double[] directions, double timeS)
        {
            var clouds = new Clouds[Count(directions)];
            Check(Native.tellus_clouds(this, directions, (UIntPtr)clouds.Length, timeS, clouds));
            return clouds;
        }

        /// Heights of the water's surface at a time under directions that lie near each other; NaN on land.
        public double[] WaterAt(double[] directions, double timeS)
        {
            var heightsM = new double[Count(directions)];
            Check(Native.tellus_water(this, directions, (UIntPtr)heightsM.Length, timeS, heightsM));
            return heightsM;
        }

        /// A square of ground in metres along east, north and up of a place; see tellus_chunk in tellus.h.
        public void Chunk(double[] direction, double sideM, uint cells, int column, int row,
            out float[] positionsM, out float[] normals, out uint[] indices)
        {
            if (direction.Length != 3)
                throw new ArgumentException("a direction has three numbers");
            if (cells < 1 || cells > MaxChunkCells)
                throw new ArgumentOutOfRangeException(nameof(cells), cells, "use 1 to " + MaxChunkCells);
            positionsM = new float[3 * (cells + 1) * (cells + 1)];
            normals = new float[3 * (cells + 1) * (cells + 1)];
            indices = new uint[6 * cells * cells];
            Check(Native.tellus_chunk(this, direction, sideM, cells, column, row, positionsM, normals));
            Check(Native.tellus_tile_indices(cells + 1, indices));
        }

        /// Where a capsule between two ends (six numbers) is skinM from the ground as it moves; null if it never is.
        public Contact? Sweep(double[] endsM, double radiusM, double[] motionM, double skinM = 0.0)
        {
            if (endsM.Length != 6 || motionM.Length != 3)
                throw new ArgumentException("ends have six numbers, a motion three");
            var contact = new Contact[1];
            int touches = Native.tellus_sweep(this, endsM, radiusM, motionM, skinM, contact);
            Check(touches >= 0);
            return touches == 1 ? contact[0] : (Contact?)null;
        }

        public uint PopulationCount => Native.tellus_population_count(this);

        public string PopulationName(uint population)
        {
            IntPtr name = Native.tellus_population_name(this, population);
            Check(name != IntPtr.Zero);
            return Text(name);
        }

        /// The objects within a radius of a direction, in ascending order of their ids.
        public Instance[] Instances(double[] direction, double radiusM)
        {
            if (direction.Length != 3)
                throw new ArgumentException("a direction has three numbers");
            long count = Native.tellus_instances(this, direction, radiusM, null, UIntPtr.Zero);
            Check(count >= 0);
            var instances = new Instance[count];
            Check(Native.tellus_instances(this, direction, radiusM, instances, (UIntPtr)instances.Length) >= 0);
            return instances;
        }

        /// The nearest object of a population, or of any (-1); null if there is none within the distance.
        public Instance? NearestObject(double[] direction, double withinM, int population = -1)
        {
            if (direction.Length != 3)
                throw new ArgumentException("a direction has three numbers");
            var instance = new Instance[1];
            int there = Native.tellus_nearest_object(this, direction, withinM, population, instance);
            Check(there >= 0);
            return there == 1 ? instance[0] : (Instance?)null;
        }

        /// The solid objects, for one thread at a time.
        public Objects SolidObjects()
        {
            Objects objects = Native.tellus_objects(this);
            Check(!objects.IsInvalid);
            return objects;
        }

        private static int Count(double[] directions)
        {
            if (directions.Length % 3 != 0)
                throw new ArgumentException("directions have three numbers each, not " + directions.Length + " in all");
            return directions.Length / 3;
        }

        private static Planet Loaded(Planet planet)
        {
            Check(!planet.IsInvalid);
            return planet;
        }

        internal static void Check(bool done)
        {
            if (!done)
                throw new TellusException(Text(Native.tellus_last_error()));
        }

        // Texts of the library are UTF-8 and stay the library's.
        private static string Text(IntPtr text)
        {
            if (text == IntPtr.Zero)
                return null;
            int length = 0;
            while (Marshal.ReadByte(text, length) != 0)
                length++;
            var bytes = new byte[length];
            Marshal.Copy(text, bytes, 0, length);
            return Encoding.UTF8.GetString(bytes);
        }

        private static byte[] Utf8(string text)
        {
            return text == null ? null : Encoding.UTF8.GetBytes(text + "\0");
        }
    }

    /// Solid objects: trunks, stones and others. One thread uses them at a time; they may outlive their planet.
    public sealed class Objects : SafeHandle
    {
        // The runtime creates the handle that a function returns.
        private Objects() : base(IntPtr.Zero, true) { }

        public override bool IsInvalid => handle == IntPtr.Zero;

        protected override bool ReleaseHandle()
        {
            Native.tellus_objects_free(handle);
            return true;
        }

        /// Where a capsule between two ends (six numbers) is nearest to an object; null if none is within the distance.
        public Contact? ContactWith(double[] endsM, double radiusM, double withinM, out ObjectName met)
        {
            if (endsM.Length != 6)
                throw new ArgumentException("ends have six numbers");
            Contact[] contact = new Contact[1];
            ObjectName[] name = new ObjectName[1];
            int touches = Native.tellus_objects_contact(this, endsM, radiusM, withinM, contact, name);
            Planet.Check(touches >= 0);
            met = name[0];
            return touches == 1 ? contact[0] : (Contact?)null;
        }

        /// Where a capsule is skinM from an object as it moves; null if it never is.
        public Contact? Sweep(double[] endsM, double radiusM, double[] motionM, double skinM, out ObjectName met)
        {
            if (endsM.Length != 6 || motionM.Length != 3)
                throw new ArgumentException("ends have six numbers, a motion three");
            Contact[] contact = new Contact[1];
            ObjectName[] name = new ObjectName[1];
            int touches = Native.tellus_objects_sweep(this, endsM, radiusM, motionM, skinM, contact, name);
            Planet.Check(touches >= 0);
            met = name[0];
            return touches == 1 ? contact[0] : (Contact?)null;
        }

        /// Distance along a ray to the first object, up to toM; infinite if it meets none.
        public double Raycast(double[] originM, double[] direction, double toM, double[] normal, out ObjectName met)
        {
            if (originM.Length != 3 || direction.Length != 3 || (normal != null && normal.Length != 3))
                throw new ArgumentException("an origin, a direction and a normal have three numbers each");
            ObjectName[] name = new ObjectName[1];
            double distanceM = Native.tellus_objects_raycast(this, originM, direction, toM, normal, name);
            Planet.Check(!double.IsNaN(distanceM));
            met = name[0];
            return distanceM;
        }

        /// Hides objects: nothing hits them any more. How many were there before.
        public long Hide(params ObjectName[] names)
        {
            long changed = Native.tellus_objects_hide(this, names, (UIntPtr)names.Length);
            Planet.Check(changed >= 0);
            return changed;
        }

        /// Shows objects again. How many were hidden.
        public long Show(params ObjectName[] names)
        {
            long changed = Native.tellus_objects_show(this, names, (UIntPtr)names.Length);
            Planet.Check(changed >= 0);
            return changed;
        }

        /// The hidden objects, for a save.
        public ObjectName[] Hidden()
        {
            long count = Native.tellus_objects_hidden(this, null, UIntPtr.Zero);
            Planet.Check(count >= 0);
            var names = new ObjectName[count];
            Planet.Check(Native.tellus_objects_hidden(this, names, (UIntPtr)names.Length) >= 0);
            return names;
        }
    }

    /// The functions as tellus.h declares them.
    internal static class Native
    {
        private const string Library = "tellus";

        [DllImport(Library)] internal static extern IntPtr tellus_version();
        [DllImport(Library)] internal static extern IntPtr tellus_last_error();
        [DllImport(Library)] internal static extern Planet tellus_planet_from_file(byte[] path, byte[] cacheFolder);
        [DllImport(Library)]
        internal static extern Planet tellus_planet_from_text(byte[] name, byte[] preset, byte[] cacheFolder);
        [DllImport(Library)] internal static extern void tellus_planet_free(IntPtr planet);
        [DllImport(Library)] internal static extern IntPtr tellus_name(Planet planet);
        [DllImport(Library)] internal static extern IntPtr tellus_hash(Planet planet);
        [DllImport(Library)] internal static extern double tellus_radius_m(Planet planet);
        [DllImport(Library)] internal static extern uint tellus_biome_count(Planet planet);
        [DllImport(Library)] internal static extern IntPtr tellus_biome_name(Planet planet, uint biome);

        // A C bool has one byte.
        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_direction(double latDeg, double lonDeg, [Out] double[] direction);

        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_heights_spaced(
            Planet planet, double[] directions, UIntPtr count, double spacingM, [Out] double[] heightsM);

        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_samples(
            Planet planet, double[] directions, UIntPtr count, [Out] Sample[] samples);

        [DllImport(Library)]
        internal static extern double tellus_raycast(Planet planet, double[] originM, double[] direction);

        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_tile(Planet planet, uint face, uint level, uint x, uint y, uint side,
            [Out] double[] positionsM, [Out] float[] normals);

        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_tile_indices(uint side, [Out] uint[] indices);

        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_clouds(
            Planet planet, double[] directions, UIntPtr count, double timeS, [Out] Clouds[] clouds);

        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_water(
            Planet planet, double[] directions, UIntPtr count, double timeS, [Out] double[] heightsM);

        [DllImport(Library)]
        [return: MarshalAs(UnmanagedType.I1)]
        internal static extern bool tellus_chunk(Planet planet, double[] direction, double sideM, uint cells,
            int column, int row, [Out] float[] positionsM, [Out] float[] normals);

        [DllImport(Library)] internal static extern uint tellus_population_count(Planet planet);
        [DllImport(Library)] internal static extern IntPtr tellus_population_name(Planet planet, uint population);

        [DllImport(Library)]
        internal static extern long tellus_instances(
            Planet planet, double[] direction, double radiusM, [Out] Instance[] instances, UIntPtr capacity);

        [DllImport(Library)]
        internal static extern int tellus_nearest_object(
            Planet planet, double[] direction, double withinM, int population, [Out] Instance[] instance);

        [DllImport(Library)] internal static extern Objects tellus_objects(Planet planet);
        [DllImport(Library)] internal static extern void tellus_objects_free(IntPtr objects);

        [DllImport(Library)]
        internal static extern int tellus_objects_contact(Objects objects, double[] endsM, double radiusM,
            double withinM, [Out] Contact[] contact, [Out] ObjectName[] met);

        [DllImport(Library)]
        internal static extern int tellus_objects_sweep(Objects objects, double[] endsM, double radiusM,
            double[] motionM, double skinM, [Out] Contact[] contact, [Out] ObjectName[] met);

        [DllImport(Library)]
        internal static extern double tellus_objects_raycast(Objects objects, double[] originM, double[] direction,
            double toM, [Out] double[] normal, [Out] ObjectName[] met);

        [DllImport(Library)]
        internal static extern long tellus_objects_hide(Objects objects, ObjectName[] names, UIntPtr count);
        [DllImport(Library)]
        internal static extern long tellus_objects_show(Objects objects, ObjectName[] names, UIntPtr count);
        [DllImport(Library)]
        internal static extern long tellus_objects_hidden(
            Objects objects, [Out] ObjectName[] names, UIntPtr capacity);

        [DllImport(Library)]
        internal static extern int tellus_sweep(
            Planet planet, double[] endsM, double radiusM, double[] motionM, double skinM, [Out] Contact[] contact);
    }
}
